// Contacts along a line, for the method `event`: parallel capsules, and a capsule along an edge or a face of a box.
// Across the line the motion is plane, and that of a ball with the capsule's radius and moment of inertia.
#include <cmath>

#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_event_line_contact)

namespace {

constexpr double kRadius = 0.12, kLength = 0.5;

// A capsule along y, or the ball of its cross-section.
Body roller(bool is_ball, const Vec3& position, double along) {
  const Capsule capsule{kRadius, kLength};
  Body body = solid("roller", capsule, position);
  const double about_axis = body.inertia(2, 2);
  if (is_ball) {
    body.shape = Sphere{kRadius};
    body.inertia = about_axis * Mat3::Identity();
  } else {
    body.orientation = Quat::FromTwoVectors(Vec3::UnitZ(), Vec3::UnitY());
    body.position.y() += along;
  }
  return body;
}

Body support(const Shape& shape, const Quat& orientation) {
  Body body = solid("support", shape, Vec3::Zero());
  body.fixed = true, body.orientation = orientation;
  return body;
}

struct Row {
  const char* what;
  Shape shape, of_ball;  // of the support: what a capsule and what a ball falls on
  Quat orientation;
  Vec3 start;
};

const Quat kAlongY = Quat::FromTwoVectors(Vec3::UnitZ(), Vec3::UnitY());
// Turned about y, so that an edge along y is the highest line, at 0.25 √2 m.
const Quat kOnEdge = rotation_by({0, 0.25 * std::numbers::pi, 0});

std::vector<Row> rows() {
  const Box box{{0.5, 3, 0.5}};
  return {{"beside a capsule", Capsule{0.2, 0.7}, Capsule{0.2, 0.7}, kAlongY, {0.05, 0, 0.6}},
          {"along an edge", box, box, kOnEdge, {0.02, 0, 0.6}},
          {"along a face", box, box, rotation_by({0, 0.2, 0}), {0.05, 0, 0.6}}};
}

BodyTable end_of(const Scene& scene, const char* integrator, double dt, double t) {
  ContactRun run(scene, "event", integrator);
  run.run(dt, static_cast<int>(std::lround(t / dt)));
  BOOST_TEST(run.solver_warning() == "");
  BOOST_TEST(!run.reduced_order());
  return BodyTable(run.state());
}

}  // namespace

// Both call a slip of 1e-7 m/s at rest, a step of 1/60 s at a time: 1.7e-9 m each time that it begins or ends.
BOOST_AUTO_TEST_CASE(a_capsule_along_a_line_moves_like_the_ball_of_its_cross_section) {
  for (const Row& row : rows()) {
    for (const auto& [restitution, friction] : {std::pair(0.0, 0.0), {0.5, 0.0}, {0.0, 0.4}, {0.5, 0.4}, {0.8, 0.1}}) {
      for (const double along : {0.0, 0.07}) {
        Scene ball =
            on_floor({roller(true, row.start, 0), support(row.of_ball, row.orientation)}, {restitution, friction});
        Scene capsule =
            on_floor({roller(false, row.start, along), support(row.shape, row.orientation)}, {restitution, friction});
        ball.bodies.pop_back(), capsule.bodies.pop_back();
        BOOST_TEST_CONTEXT(row.what << ", e = " << restitution << ", mu = " << friction << ", along " << along) {
          const BodyTable is = end_of(capsule, "dormand-prince", 1.0 / 60, 0.6),
                          due = end_of(ball, "dormand-prince", 1.0 / 60, 0.6);
          const Vec3 position = is.columns().position(0) - Vec3(0, along, 0);
          BOOST_TEST((position - due.columns().position(0)).norm() < 1e-8);
          BOOST_TEST((is.columns().velocity(0) - due.columns().velocity(0)).norm() < 1e-7);
          BOOST_TEST((is.columns().angular_velocity(0) - due.columns().angular_velocity(0)).norm() < 1e-6);
        }
      }
    }
  }
}

// A capsule crosses a fixed one at a small angle and rolls off it. Steps of any length give the same motion, so that
// the contact follows the crossing inside each step.
BOOST_AUTO_TEST_CASE(capsules_that_cross_at_a_small_angle_are_followed_inside_each_step) {
  for (const double angle : {1e-4, 1e-3, 5e-3, 0.03}) {
    Body capsule = roller(false, {0.02, 0, 0.36}, 0.02);
    capsule.orientation = rotation_by({0, 0, angle}) * capsule.orientation;
    capsule.angular_velocity = {0, 0, 0.2};
    Scene scene = on_floor({capsule, support(Capsule{0.2, 0.7}, kAlongY)}, {0, 0.3});
    scene.bodies.pop_back();
    const BodyTable coarse = end_of(scene, "dormand-prince", 1.0 / 30, 0.4),
                    fine = end_of(scene, "dormand-prince", 1.0 / 480, 0.4);
    BOOST_TEST((coarse.columns().position(0) - fine.columns().position(0)).norm() < 1e-8, angle);
    BOOST_TEST(angle_between(coarse.columns().orientation(0), fine.columns().orientation(0)) < 1e-8, angle);
  }
}

BOOST_AUTO_TEST_SUITE_END()
