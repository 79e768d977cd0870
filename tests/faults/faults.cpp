#include "tests/faults/faults.h"

#include <cmath>
#include <limits>

#include "core/dynamics/model/loads.h"
#include "core/dynamics/model/system.h"
#include "tests/faults/contact_faults.h"
#include "tests/faults/scene_faults.h"

namespace rigor::test {
namespace {

template <typename F>
std::function<void(Scene&)> each_spring(F change) {
  return [change](Scene& scene) {
    for (Spring& spring : scene.springs) change(spring);
  };
}

template <typename F>
std::function<void(Scene&)> each_force(F change) {
  return [change](Scene& scene) {
    for (TimedForce& force : scene.forces) change(force);
  };
}

// On every moving body, before each step.
template <typename F>
std::function<void(Moment&)> each_moving(F change) {
  return [change](Moment& moment) {
    for (Body& body : moment.scene.bodies) {
      if (!body.fixed) change(body, moment.dt);
    }
  };
}

template <typename F>
std::function<void(MutableBodyColumns, const Scene&)> each_read(F change) {
  return [change](MutableBodyColumns bodies, const Scene&) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      BodyState state = BodyColumns(bodies).body(i);
      change(state);
      bodies.set_body(i, state);
      if (bodies.has_rotation()) bodies.set_rotation(i, matrix_of(state.orientation));
    }
  };
}

Quat shifted_components(const Quat& q) { return {q.z(), q.w(), q.x(), q.y()}; }  // (x, y, z, w) taken for (w, x, y, z)

double single(double x) { return static_cast<float>(x); }
Vec3 single(const Vec3& v) { return v.cast<float>().cast<double>(); }

BodyState single(const BodyState& s) {
  return {
      single(s.position),
      Quat(single(s.orientation.w()), single(s.orientation.x()), single(s.orientation.y()), single(s.orientation.z())),
      single(s.velocity), single(s.angular_velocity)};
}

// What the gyroscopic term adds to w in a step, and so `times` more of it. -1: it is dropped; -2: its sign is wrong.
std::function<void(Moment&)> gyroscopic(double times) {
  return each_moving([times](Body& body, double dt) {
    const Mat3 R = matrix_of(body.orientation), I = R * body.inertia * R.transpose();
    const Vec3 w = body.angular_velocity;
    body.angular_velocity -= times * dt * I.inverse() * w.cross(I * w);
  });
}

Vec3 speed_of_point(const Body& body, const Vec3& point_B) {
  return body.velocity + body.angular_velocity.cross(body.orientation * point_B);
}

void push(Body& body, const Vec3& impulse, const Vec3& point_B) {
  if (body.fixed) return;
  const Mat3 R = matrix_of(body.orientation);
  body.velocity += impulse / body.mass;
  body.angular_velocity += R * body.inertia.inverse() * (R.transpose() * (R * point_B).cross(impulse));
}

// A damper that brakes every motion of its end, and not only that along its line.
void damp_all_ways(Moment& moment) {
  for (Spring& spring : moment.scene.springs) {
    if (spring.b == kWorld) continue;
    Body& body = moment.scene.bodies[spring.b];
    push(body, -spring.damping * moment.dt * speed_of_point(body, spring.point_b), spring.point_b);
    spring.damping = 0;
  }
}

Vec3 end_of(const Scene& scene, int body, const Vec3& point) {
  return body == kWorld ? point : scene.bodies[body].position + scene.bodies[body].orientation * point;
}

// A spring between two bodies acts on b alone: what it gives to a is taken back.
void drop_reactions(Moment& moment) {
  for (const Spring& spring : moment.scene.springs) {
    if (spring.a == kWorld || spring.b == kWorld) continue;
    const Vec3 line = end_of(moment.scene, spring.b, spring.point_b) - end_of(moment.scene, spring.a, spring.point_a);
    const Vec3 on_a = spring.stiffness * (line.norm() - spring.rest_length) * line.normalized();
    push(moment.scene.bodies[spring.a], -moment.dt * on_a, spring.point_a);
  }
}

void slacken_when_short(Moment& moment) {
  for (Spring& spring : moment.scene.springs) {
    const Vec3 line = end_of(moment.scene, spring.b, spring.point_b) - end_of(moment.scene, spring.a, spring.point_a);
    if (line.norm() < spring.rest_length) spring.stiffness = 0;
  }
}

void forces_in_body_frame(Moment& moment) {
  for (TimedForce& force : moment.scene.forces) force.force = moment.scene.bodies[force.body].orientation * force.force;
}

void torques_in_body_frame(Moment& moment) {
  for (TimedForce& force : moment.scene.forces)
    force.torque = moment.scene.bodies[force.body].orientation * force.torque;
}

void forces_a_step_late(Moment& moment) {
  for (TimedForce& force : moment.scene.forces) force.from += moment.dt, force.until += moment.dt;
}

// What was applied in a step is still there in the next, to which its own is added.
void forces_add_up(Moment& moment) {
  for (std::size_t i = 0; i < moment.scene.forces.size(); ++i) {
    TimedForce& force = moment.scene.forces[i];
    const double since = moment.time - moment.original.forces[i].from;
    if (since < 0 || force.until <= 0) continue;
    const double applied = 1 + std::floor(since / moment.dt + 0.5);
    force.force *= applied, force.torque *= applied;
  }
}

void fall_asleep(Body& body, double) {
  if (body.velocity.norm() > 0.05 || body.angular_velocity.norm() > 0.05) return;
  body.velocity.setZero(), body.angular_velocity.setZero();
}

void reversed_order(MutableBodyColumns bodies, const Scene&) {
  for (std::size_t i = 0, j = bodies.size() - 1; i < j; ++i, --j) {
    const BodyState one = BodyColumns(bodies).body(i), other = BodyColumns(bodies).body(j);
    bodies.set_body(i, other), bodies.set_body(j, one);
  }
}

void scale_off_diagonal(Body& body, double factor) {
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) body.inertia(r, c) *= r == c ? 1 : factor;
  }
}

const std::string kPlace = "position_error|unexplained_error", kTurn = "orientation_error|unexplained_rotation",
                  kMomentum = "|angular_momentum_drift", kEnergy = "|energy_drift|energy_drift_synchronised";

std::vector<Fault> of_bodies() {
  return {
      {"gravity off by 0.1 %", "ballistic/free-fall", kPlace, [](Scene& s) { s.gravity *= 1.001; }},
      {"gravity reversed", "ballistic/free-fall", kPlace, [](Scene& s) { s.gravity *= -1; }},
      {"gravity left out", "ballistic/free-fall", kPlace, [](Scene& s) { s.gravity.setZero(); }},
      {"gravity along another axis", "ballistic/projectile", kPlace,
       [](Scene& s) {
         s.gravity = s.gravity.reverse().eval(), s.gravity = Vec3(s.gravity.y(), s.gravity.z(), s.gravity.x());
       }},
      {"mass off by 0.1 %", "springs/oscillator", kPlace, each_body([](Body& b) { b.mass *= 1.001; })},
      {"mass ratio ignored", "springs/mass-ratio", kPlace, equal_masses},
      {"inertia off by 0.1 %", "forces/principal-torque", kTurn, each_body([](Body& b) { b.inertia *= 1.001; })},
      {"inertia in the wrong frame", "tops/off-diagonal-inertia", kTurn + kMomentum, each_body([](Body& b) {
         const Mat3 R = matrix_of(b.orientation);
         b.inertia = (R.transpose() * b.inertia * R).eval();
       })},
      {"inertia's axes in another order", "tops/asymmetric-top", kTurn + kMomentum,
       each_body([](Body& b) { b.inertia = Vec3(b.inertia(2, 2), b.inertia(0, 0), b.inertia(1, 1)).asDiagonal(); })},
      {"products of inertia left out", "tops/off-diagonal-inertia", kTurn + kMomentum,
       each_body([](Body& b) { scale_off_diagonal(b, 0); })},
      {"products of inertia with the other sign", "tops/off-diagonal-inertia", kTurn + kMomentum,
       each_body([](Body& b) { scale_off_diagonal(b, -1); })},
      {"every body a sphere", "tops/dzhanibekov-box", kTurn + kMomentum,
       each_body([](Body& b) { b.inertia = Mat3::Identity() * b.inertia.trace() / 3; })},
      {"velocity lost on loading", "ballistic/projectile", kPlace, each_body([](Body& b) { b.velocity.setZero(); })},
      {"velocity taken in the body frame", "ballistic/projectile", kPlace,
       each_body([](Body& b) { b.velocity = b.orientation * b.velocity; })},
      {"angular velocity taken in the body frame", "ballistic/projectile", kTurn,
       each_body([](Body& b) { b.angular_velocity = b.orientation * b.angular_velocity; })},
      {"angular velocity taken in degrees", "ballistic/fast-spin", kTurn,
       each_body([](Body& b) { b.angular_velocity *= 0.017453292519943295; })},
      {"quaternion order swapped on loading", "ballistic/projectile", kTurn,
       each_body([](Body& b) { b.orientation = shifted_components(b.orientation); })},
      {"conjugate rotation on loading", "ballistic/projectile", kTurn,
       each_body([](Body& b) { b.orientation = b.orientation.conjugate(); })},
  };
}

// In a joint that is rotated, off the middle of its body, and to the world.
std::vector<Fault> of_joints() {
  const auto hinge = [](Scene& s) -> HingeJoint& { return std::get<HingeJoint>(s.joints[0].type); };
  const std::string shown_by = "joints/chrono-revolute", metrics = kPlace + "|" + kTurn;
  return {
      {"a hinge's anchor off by 1 mm", shown_by, metrics, [=](Scene& s) { hinge(s).anchor += Vec3(1e-3, 0, 0); }},
      {"a hinge's axis off by 1 mrad", shown_by, metrics,
       [=](Scene& s) { hinge(s).axis = (hinge(s).axis + Vec3(1e-3, 0, 0)).normalized(); }},
      {"a hinge taken for a ball", shown_by, metrics, [=](Scene& s) { s.joints[0].type = BallJoint{hinge(s).anchor}; }},
      {"a joint left out", shown_by, metrics, [](Scene& s) { s.joints.clear(); }},
  };
}

std::vector<Fault> of_loads() {
  return {
      {"spring stiffness off by 0.1 %", "springs/oscillator", kPlace,
       each_spring([](Spring& s) { s.stiffness *= 1.001; })},
      {"spring counted twice", "springs/oscillator", kPlace, [](Scene& s) { s.springs.push_back(s.springs.back()); }},
      {"a spring left out", "springs/body-springs", kPlace, [](Scene& s) { s.springs.pop_back(); }},
      {"spring rest length off by 1 mm", "springs/oscillator", kPlace,
       each_spring([](Spring& s) { s.rest_length += 1e-3; })},
      {"spring rest length left out", "springs/two-bodies", kPlace, each_spring([](Spring& s) { s.rest_length = 0; })},
      {"spring slack when short", "springs/mass-ratio", kPlace, {}, slacken_when_short},
      {"torque arm dropped", "springs/fixed-spring", kTurn + "|" + kPlace,
       each_spring([](Spring& s) { s.point_b.setZero(); })},
      {"torque arm reversed", "springs/fixed-spring", kTurn + "|" + kPlace,
       each_spring([](Spring& s) { s.point_b *= -1; })},
      {"torque arm not turned with the body",
       "springs/hung-part",
       kTurn + "|" + kPlace,
       {},
       [](Moment& m) {
         for (Spring& s : m.scene.springs) s.point_b = m.scene.bodies[s.b].orientation.conjugate() * s.point_b;
       }},
      {"a spring's ends swapped", "springs/body-springs", kTurn + "|" + kPlace,
       each_spring([](Spring& s) { std::swap(s.point_a, s.point_b); })},
      {"a spring without reaction", "springs/two-bodies", kPlace + "|linear_momentum_drift", {}, drop_reactions},
      {"damping left out", "springs/oscillator-underdamped", kPlace + kEnergy,
       each_spring([](Spring& s) { s.damping = 0; })},
      {"damping off by 1 %", "springs/oscillator-underdamped", kPlace + kEnergy,
       each_spring([](Spring& s) { s.damping *= 1.01; })},
      {"damping that drives", "springs/oscillator-underdamped", kPlace + kEnergy,
       each_spring([](Spring& s) { s.damping *= -1; })},
      {"damping along the wrong direction", "springs/hung-part", kPlace + "|" + kTurn, {}, damp_all_ways},
      {"force off by 0.1 %", "forces/switches-inside-steps", kPlace,
       each_force([](TimedForce& f) { f.force *= 1.001; })},
      {"force that does not end", "forces/switches-inside-steps", kPlace,
       each_force([](TimedForce& f) { f.until = std::numeric_limits<double>::infinity(); })},
      {"force not cleared after a step", "forces/switches-inside-steps", kPlace, {}, forces_add_up},
      {"force applied one step late", "forces/switches-inside-steps", kPlace, {}, forces_a_step_late},
      {"force taken in the body frame", "forces/switches-inside-steps", kPlace, {}, forces_in_body_frame},
      {"force's arm dropped", "forces/compass-needle", kTurn, each_force([](TimedForce& f) { f.point.setZero(); })},
      {"torque left out", "forces/principal-torque", kTurn, each_force([](TimedForce& f) { f.torque.setZero(); })},
      {"torque taken in the body frame", "forces/torqued-top", kTurn, {}, torques_in_body_frame},
      {"torque reversed", "forces/principal-torque", kTurn, each_force([](TimedForce& f) { f.torque *= -1; })},
  };
}

std::vector<Fault> of_steps() {
  return {
      {"gyroscopic term dropped", "tops/dzhanibekov-box", kTurn + kMomentum, {}, gyroscopic(-1)},
      {"sign of the gyroscopic term", "tops/dzhanibekov-box", kTurn + kMomentum, {}, gyroscopic(-2)},
      {"gyroscopic term doubled", "tops/dzhanibekov-box", kTurn + kMomentum, {}, gyroscopic(1)},
      {"dt halved for every tenth step",
       "ballistic/projectile",
       kPlace + "|" + kTurn,
       {},
       [](Moment& m) { m.dt *= m.step % 10 == 9 ? 0.5 : 1; }},
      {"one sub-step too many",
       "ballistic/projectile",
       kPlace + "|" + kTurn,
       {},
       [](Moment& m) { m.times += m.step == 0; }},
      {"every hundredth step left out",
       "ballistic/free-fall",
       kPlace,
       {},
       [](Moment& m) { m.times -= m.step % 100 == 99; }},
      {"dt in single precision", "ballistic/free-fall", kPlace, {}, [](Moment& m) { m.dt = single(m.dt); }},
      {"time steps of 1/60 s whatever is asked", "ballistic/free-fall", kPlace, {}, [](Moment& m) { m.dt = 1.0 / 60; }},
      {"single-precision state", "springs/oscillator", kPlace, {}, each_moving([](Body& b, double) {
         b.position = single(b.position), b.velocity = single(b.velocity);
       })},
      {"speed clamped at 5 m/s", "ballistic/free-fall", kPlace, {}, each_moving([](Body& b, double) {
         if (b.velocity.norm() > 5) b.velocity *= 5 / b.velocity.norm();
       })},
      {"spin clamped at 5 rad/s", "ballistic/fast-spin", kTurn, {}, each_moving([](Body& b, double) {
         if (b.angular_velocity.norm() > 5) b.angular_velocity *= 5 / b.angular_velocity.norm();
       })},
      {"small linear damping left on", "ballistic/projectile", kPlace, {}, each_moving([](Body& b, double dt) {
         b.velocity *= 1 - 0.001 * dt;
       })},
      {"small angular damping left on",
       "ballistic/fast-spin",
       kTurn + kMomentum + kEnergy,
       {},
       each_moving([](Body& b, double dt) { b.angular_velocity *= 1 - 0.001 * dt; })},
      {"sleeping left on", "springs/oscillator-overdamped", kPlace, {}, each_moving(fall_asleep)},
      {"gravity while a body is slow left out",
       "springs/oscillator",
       kPlace,
       {},
       [](Moment& m) {
         if (m.scene.bodies[0].velocity.norm() < 0.1) m.scene.gravity.setZero();
       }},
      {"orientation that creeps", "ballistic/projectile", kTurn, {}, each_moving([](Body& b, double dt) {
         b.orientation = rotation_by(Vec3(1e-4 * dt, 0, 0)) * b.orientation;
       })},
      {"positions kept to a grid of 0.1 mm", "springs/oscillator", kPlace, {}, each_moving([](Body& b, double) {
         b.position = (b.position * 1e4).array().round().matrix() * 1e-4;
       })},
  };
}

std::vector<Fault> of_reading() {
  const auto on_read = [](const char* name, const char* by, const std::string& metrics, auto change) {
    Fault fault{name, by, metrics};
    fault.read = each_read(change);
    return fault;
  };
  Fault wrong_order{"bodies read back in the wrong order", "springs/body-springs", kPlace},
      late{"state read before the step", "ballistic/projectile", kPlace + "|" + kTurn};
  wrong_order.read = reversed_order, late.reads_late = true;
  return {
      on_read("quaternion order swapped on reading", "ballistic/projectile", kTurn,
              [](BodyState& s) { s.orientation = shifted_components(s.orientation); }),
      on_read("conjugate rotation on reading", "ballistic/projectile", kTurn,
              [](BodyState& s) { s.orientation = s.orientation.conjugate(); }),
      on_read("angular velocity read in the body frame", "ballistic/projectile",
              "angular_velocity_error|unexplained_spin",
              [](BodyState& s) { s.angular_velocity = s.orientation.conjugate() * s.angular_velocity; }),
      on_read("angular velocity reversed on reading", "ballistic/projectile", "angular_velocity_error|unexplained_spin",
              [](BodyState& s) { s.angular_velocity *= -1; }),
      on_read("velocity off by 1 % on reading", "ballistic/projectile", "velocity_error|unexplained_velocity",
              [](BodyState& s) { s.velocity *= 1.01; }),
      on_read("unnormalised quaternion", "ballistic/projectile", "orthonormality_error",
              [](BodyState& s) { s.orientation.coeffs() *= 1.0001; }),
      on_read("position of a point beside the centre", "ballistic/projectile", kPlace,
              [](BodyState& s) { s.position += s.orientation * Vec3(0, 0, 1e-3); }),
      on_read("bodies a millimetre beside their joints on reading", "joints/pendulum-90", "joint_gap|unexplained_error",
              [](BodyState& s) { s.position.z() += 1e-3; }),
      on_read("single precision on reading", "ballistic/free-fall", kPlace, [](BodyState& s) { s = single(s); }),
      on_read("left-handed axes on reading", "ballistic/projectile", kPlace,
              [](BodyState& s) { s.position.x() *= -1; }),
      wrong_order,
      late,
  };
}

}  // namespace

const std::vector<Fault>& faults() {
  static const std::vector<Fault> table = [] {
    std::vector<Fault> all;
    for (const auto& part : {of_bodies(), of_loads(), of_joints(), of_steps(), contact_faults(), of_reading()})
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return table;
}

}  // namespace rigor::test
