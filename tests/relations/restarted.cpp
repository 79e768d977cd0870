#include <algorithm>
#include <cmath>

#include "cases/analysis/divergence/rebased_scene.h"
#include "core/dynamics/model/joint_coordinate.h"
#include "tests/relations/relations.h"

namespace rigor::test {
namespace {

// rad: a hinge that turns farther has another angle, within half a turn, in the scene that begins later.
constexpr double kMostTurn = 2.5;

bool has_load(const Scene& scene, std::size_t joint) {
  const Joint& one = scene.joints[joint];
  return one.stiffness > 0 || one.has_limits() ||
         std::any_of(scene.motors.begin(), scene.motors.end(),
                     [&](const Motor& motor) { return motor.servo && motor.drives(static_cast<int>(joint)); });
}

bool has_compounds(const Scene& scene) {
  return std::any_of(scene.joints.begin(), scene.joints.end(), is_axis_of_compound);
}

bool has_samples(const Scene& scene) {
  return std::any_of(scene.motors.begin(), scene.motors.end(),
                     [](const Motor& motor) { return motor.servo && motor.servo->period > 0; });
}

// As `rigor diverge` begins a scene anew.
std::optional<Scene> rebased_scene(const Scene& scene, const std::vector<BodyTable>& until_then, double t) {
  JointCoordinates coordinates(scene);
  std::vector<BodyState> bodies(scene.bodies.size());
  for (const BodyTable& state : until_then) {
    for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i] = state.columns().body(i);
    coordinates.follow(bodies);
    for (std::size_t j = 0; j < scene.joints.size(); ++j)
      if (has_load(scene, j) && turns(scene.joints[j]) && std::abs(coordinates.values()[j]) > kMostTurn) return {};
  }
  return rebased(scene, bodies, coordinates.values(), t);
}

void set_state(Scene& scene, BodyColumns state) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    Body& body = scene.bodies[i];
    if (body.fixed) continue;
    body.position = state.position(i), body.orientation = state.orientation(i).normalized();
    body.velocity = state.velocity(i), body.angular_velocity = state.angular_velocity(i);
  }
}

// A joint's anchor is a point of b. Its directions move with a, but for the second axis of a universal joint.
void move_joint(Joint& joint, const Scene& before, const Scene& after) {
  for_each_vector(joint.type, [&](const std::string& key, JointVector kind, Vec3& vector) {
    if (kind == JointVector::point_of_a || kind == JointVector::point_of_b) return;
    const int body = kind == JointVector::point || key == "axis2" ? joint.b : joint.a;
    const BodyPose from = before.pose(body), to = after.pose(body);
    const Quat turn = to.orientation * from.orientation.conjugate();
    vector = kind == JointVector::point ? to.position + turn * (vector - from.position) : turn * vector;
  });
}

void shift(TimeTable& table, double time, double value) {
  for (double& each : table.times) each -= time;
  for (double& each : table.values) each -= value;
}

// The coordinates begin at 0 again.
bool shift_coordinates(Scene& scene, const Scene& before, const std::vector<BodyTable>& until_then) {
  std::vector<double> passed(scene.joints.size());
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    if (!free_axis(before.joints[j])) continue;
    const JointCoordinate coordinate(before, before.joints[j]);
    for (const BodyTable& state : until_then) {
      passed[j] = coordinate.at(state.columns()).x;
      if (coordinate.turns() && has_load(before, j) && std::abs(passed[j]) > kMostTurn) return false;
    }
    Joint& joint = scene.joints[j];
    joint.rest -= passed[j];
    joint.lower = std::min(0.0, joint.lower - passed[j]), joint.upper = std::max(0.0, joint.upper - passed[j]);
  }
  for (Motor& motor : scene.motors)
    if (motor.servo) shift(motor.servo->target, 0, passed[static_cast<std::size_t>(motor.joint)]);
  return true;
}

void shift_time(Scene& scene, double t) {
  for (Motor& motor : scene.motors) {
    motor.from = std::max(0.0, motor.from - t), motor.until -= t;
    if (motor.efforts) shift(*motor.efforts, t, 0);
    if (motor.servo) shift(motor.servo->target, t, 0);
  }
  for (TimedForce& force : scene.forces) force.from = std::max(0.0, force.from - t), force.until -= t;
  std::erase_if(scene.motors, [](const Motor& motor) { return motor.until <= 0; });
  std::erase_if(scene.forces, [](const TimedForce& force) { return force.until <= 0; });
}

bool loses_energy(const Scene& scene) {
  const auto damps = [](const auto& row) { return row.damping > 0; };
  const auto bounces_less = [](const Joint& joint) { return joint.has_limits() && joint.restitution < 1; };
  const auto is_no_effort = [](const Motor& motor) { return !motor.gives_effort() || motor.efforts; };
  const auto rubs = [](const ContactLaw& law) { return law.restitution < 1 || law.friction > 0; };
  const bool can_touch =
      std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const Body& b) { return b.collides; });
  return std::any_of(scene.springs.begin(), scene.springs.end(), damps) ||
         std::any_of(scene.joints.begin(), scene.joints.end(), damps) ||
         std::any_of(scene.joints.begin(), scene.joints.end(), bounces_less) ||
         std::any_of(scene.motors.begin(), scene.motors.end(), is_no_effort) || (can_touch && any_law(scene, rubs));
}

template <typename Row>
void turn_time(std::vector<Row>& rows, double t) {
  for (Row& row : rows) {
    const double from = row.from;
    row.from = std::max(0.0, t - row.until), row.until = t - from;
  }
  std::erase_if(rows, [](const Row& row) { return row.until <= 0; });
}

std::optional<Scene> begun_anew(const Scene& scene, const std::vector<BodyTable>& until_then) {
  Scene made = scene;
  set_state(made, until_then.back().columns());
  for (Joint& joint : made.joints) move_joint(joint, scene, made);
  if (has_compounds(scene) || !shift_coordinates(made, scene, until_then)) return {};
  return made;
}

}  // namespace

std::optional<Scene> restarted(const Scene& scene, const std::vector<BodyTable>& until_then, double t) {
  if (has_samples(scene)) return {};
  if (has_compounds(scene)) return rebased_scene(scene, until_then, t);
  std::optional<Scene> made = begun_anew(scene, until_then);
  if (made) shift_time(*made, t);
  return made;
}

std::optional<Scene> reversed(const Scene& scene, const std::vector<BodyTable>& until_then, double t) {
  if (loses_energy(scene) || has_samples(scene)) return {};
  std::optional<Scene> made = begun_anew(scene, until_then);
  if (!made) return {};
  for (Body& body : made->bodies) body.velocity = -body.velocity, body.angular_velocity = -body.angular_velocity;
  turn_time(made->motors, t), turn_time(made->forces, t);
  return made;
}

}  // namespace rigor::test
