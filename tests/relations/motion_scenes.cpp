#include <algorithm>

#include "tests/relations/random.h"
#include "tests/relations/scenes.h"
#include "tests/scenes.h"

namespace rigor::test {
namespace {

// With the inertia of some matter: squares of its extents along its own axes.
Body any_body(Random& random, int i, const Vec3& position) {
  const double mass = random.log_between(0.1, 10);
  const Vec3 squares =
      Vec3(random.log_between(0.05, 0.3), random.log_between(0.05, 0.3), random.log_between(0.05, 0.3)).cwiseAbs2();
  Body made = body("b" + std::to_string(i), mass, mass / 3 * (Vec3::Constant(squares.sum()) - squares), position);
  const Mat3 axes = matrix_of(random.turn());
  made.inertia = (axes * made.inertia * axes.transpose()).eval();
  made.inertia = (0.5 * (made.inertia + made.inertia.transpose())).eval();
  made.orientation = random.turn();
  return made;
}

// Moves the whole scene as one rigid body, which no joint resists.
void set_moving(Scene& scene, const Vec3& velocity, const Vec3& turn_rate, const Vec3& about) {
  for (Body& body : scene.bodies) {
    body.angular_velocity = turn_rate;
    body.velocity = velocity + turn_rate.cross(body.position - about);
  }
}

// Arms are of the size of the bodies. So no frequency is much above 15 rad/s, and fixed steps resolve all.
Spring any_spring(Random& random, const Scene& scene, int a, int b, bool has_dampers) {
  const auto mass = [&](int i) { return i == kWorld ? 1e9 : scene.bodies[static_cast<std::size_t>(i)].mass; };
  const double rate = random.between(2, 10), stiffness = std::min(mass(a), mass(b)) * rate * rate;
  const Vec3 end = a == kWorld ? random.vector(0.7) : random.vector(0.1);
  Spring made = spring(a, end, b, random.vector(0.1), stiffness, random.between(0, 0.6));
  if (has_dampers && random.chance(0.6)) made.damping = 0.2 * stiffness / rate * random.share();
  if (random.chance(0.3)) made.quadratic_stiffness = stiffness;
  return made;
}

class Mechanism {
 public:
  Mechanism(unsigned seed, bool is_compound) : random_(seed), is_compound_(is_compound) {}

  Scene scene() {
    scene_.gravity = random_.vector(9);
    is_free_ = random_.chance(0.4), has_losses_ = random_.chance(0.7), is_plain_ = random_.chance(0.5);
    const int size = 2 + random_.below(4);
    for (int i = 0; i < size; ++i) add_link(i);
    add_coupling();
    if (is_free_) set_moving(scene_, random_.vector(1), random_.vector(2), Vec3::Zero());
    return scene_;
  }

 private:
  void add_link(int self) {
    const int parent = self > 0 ? random_.below(self) : kWorld;
    const Vec3 base = parent == kWorld ? Vec3::Zero() : scene_.bodies[parent].position, at = base + random_.vector(0.5);
    scene_.bodies.push_back(any_body(random_, self, at));
    if (parent == kWorld && is_free_) return;
    const Vec3 anchor = 0.5 * (at + base) + random_.vector(0.1);
    if (is_compound_ && random_.chance(0.7)) return add_compound(parent, self, anchor);
    Joint joint{.a = parent, .b = self, .type = any_type(anchor)};
    if (free_axis(joint)) load(joint);
    scene_.joints.push_back(joint);
  }

  // One to three hinges and up to two sliders in any order, and as near to right angles as hips and roots of robots.
  void add_compound(int parent, int self, const Vec3& anchor) {
    const int hinges = 1 + random_.below(3), sliders = random_.below(3);
    const Mat3 hinged = matrix_of(random_.turn()), slid = matrix_of(random_.turn());
    std::vector<SeriesAxis> axes;
    for (int k = 0, turning = 0, sliding = 0; k < hinges + sliders; ++k) {
      const bool turns = sliding == sliders || (turning < hinges && random_.chance(0.5));
      const Vec3 along = turns ? hinged.col(turning++) : slid.col(sliding++);
      axes.push_back({turns, turns ? Vec3(anchor + random_.vector(0.1)) : Vec3(Vec3::Zero()),
                      (along + random_.vector(0.2)).normalized()});
    }
    scene_.joints.push_back({.a = parent, .b = self, .type = CompoundJoint{axes}});
    for (std::size_t k = 0; k < axes.size(); ++k) {
      Joint axis{.a = parent, .b = self, .type = CompoundAxis{axes, k}};
      load(axis);
      scene_.joints.push_back(axis);
    }
  }

  JointType any_type(const Vec3& anchor) {
    const Vec3 axis = random_.direction();
    const double kind = random_.share();
    if (is_plain_ || kind < 0.4) {
      if (kind < 0.15) return BallJoint{anchor};
      if (kind > 0.8) return SliderJoint{axis};
      return HingeJoint{anchor, axis};
    }
    const Vec3 across = axis.unitOrthogonal();
    const Vec3 in_body = random_.vector(0.1);
    const std::vector<JointType> others = {UniversalJoint{anchor, axis, across},
                                           CylindricalJoint{anchor, axis},
                                           PlanarJoint{anchor, axis},
                                           ScrewJoint{anchor, axis, 0.3},
                                           FixedJoint{},
                                           DistanceJoint{in_body, -in_body}};
    return random_.one_of(others);
  }

  // Springs, dampers, limits and motors of a joint with an axis. Rates stay below some 10 rad/s, which steps resolve.
  void load(Joint& joint) {
    const double unit = inertia_at(joint);
    if (random_.chance(0.4)) joint.stiffness = 50 * unit, joint.rest = random_.between(-0.3, 0.3);
    if (joint.stiffness > 0 && random_.chance(0.5)) joint.quadratic_stiffness = 40 * unit;
    if (has_losses_ && random_.chance(0.4)) joint.damping = random_.between(0.1, 3) * unit;
    if (random_.chance(0.3)) joint.lower = -random_.between(0.1, 0.8), joint.upper = random_.between(0.1, 0.8);
    if (joint.has_limits()) joint.restitution = has_losses_ ? random_.one_of<double>({0, 0.5}) : 1;
    if (!is_plain_ && random_.chance(0.2)) joint.armature = random_.between(0.05, 2) * unit;
    if (random_.chance(0.4)) add_motor(unit);
  }

  // kg m² or kg: what a unit of effort moves at least, of the lighter end.
  double inertia_at(const Joint& joint) const {
    double least = std::numeric_limits<double>::infinity();
    for (const int end : {joint.a, joint.b}) {
      if (end == kWorld) continue;
      const Body& body = scene_.bodies[static_cast<std::size_t>(end)];
      least = std::min(least, turns(joint) ? body.inertia.diagonal().minCoeff() : body.mass);
    }
    return least;
  }

  void add_motor(double unit) {
    Motor motor;
    motor.joint = static_cast<int>(scene_.joints.size());
    motor.from = random_.between(0, 0.1), motor.most = random_.between(2, 30) * unit;
    const auto effort = [&] { return random_.between(-10, 10) * unit; };
    switch (is_plain_ || !has_losses_ ? 0 : random_.below(5)) {
      case 1:
        motor.speed = random_.between(-2, 2);
        break;
      case 2:
        motor.speed = 0, motor.is_friction = true, motor.from = 0;
        break;
      case 3:
        motor.efforts = TimeTable{{0.1, 0.3, 0.4}, {effort(), effort(), 0}};
        break;
      case 4:
        motor.servo = any_servo(unit);
        break;
      default:
        motor.effort = effort();
    }
    scene_.motors.push_back(motor);
  }

  Servo any_servo(double unit) {
    Servo servo;
    servo.target = random_.chance(0.5) ? TimeTable::constant(random_.between(-0.5, 0.5))
                                       : TimeTable{{0, 0.2, 0.35}, {0, random_.between(-0.4, 0.4), 0.1}};
    servo.kp = random_.between(10, 80) * unit, servo.kd = random_.between(0, 5) * unit;
    if (random_.chance(0.3)) servo.most = random_.between(2, 20) * unit;
    return servo;
  }

  // Two joints with a coordinate, of which no motor gives the speed.
  void add_coupling() {
    if (is_plain_ || !random_.chance(0.3)) return;
    std::vector<int> with_axis;
    for (std::size_t i = 0; i < scene_.joints.size(); ++i)
      if (free_axis(scene_.joints[i]) && !scene_.joints[i].has_limits()) with_axis.push_back(static_cast<int>(i));
    if (with_axis.size() < 2) return;
    scene_.couplings.push_back({with_axis[1], {{with_axis[0], random_.between(0.5, 2)}}});
    std::erase_if(scene_.motors,
                  [&](const Motor& motor) { return motor.speed && scene_.couplings[0].joins(motor.joint); });
  }

  Random random_;
  Scene scene_;
  bool is_compound_;
  bool is_free_ = false, has_losses_ = false, is_plain_ = false;
};

}  // namespace

Scene smooth_scene(unsigned seed) {
  Random random(seed);
  Scene scene;
  scene.gravity = random.vector(9);
  const bool is_free = random.chance(0.4), has_dampers = random.chance(0.6);
  const int count = 1 + random.below(4);
  for (int i = 0; i < count; ++i) {
    scene.bodies.push_back(any_body(random, i, random.vector(1)));
    scene.bodies.back().velocity = random.vector(1), scene.bodies.back().angular_velocity = random.vector(3);
    const int a = i > 0 ? random.below(i) : kWorld;
    if (a != kWorld || !is_free) scene.springs.push_back(any_spring(random, scene, a, i, has_dampers));
    if (!is_free && random.chance(0.3)) scene.springs.push_back(any_spring(random, scene, kWorld, i, has_dampers));
    if (!random.chance(0.3)) continue;
    TimedForce force;
    force.body = i, force.force = random.vector(2), force.torque = random.vector(0.05),
    force.point = random.vector(0.1);
    if (random.chance(0.5)) force.from = 0.1, force.until = 0.3;
    scene.forces.push_back(force);
  }
  return scene;
}

Scene mechanism(unsigned seed) { return Mechanism(seed, false).scene(); }

Scene compound_mechanism(unsigned seed) { return Mechanism(seed, true).scene(); }

}  // namespace rigor::test
