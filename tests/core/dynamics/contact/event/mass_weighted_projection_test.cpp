#include "core/dynamics/contact/event/mass_weighted_projection.h"

#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_event_mass_weighted_projection)

BOOST_AUTO_TEST_CASE(what_no_motion_can_do_is_said_and_moves_nothing) {
  Scene scene;
  scene.bodies = {solid("free", Sphere{1}, {0, 0, 3}, 2), floor_at(), solid("fixed", Sphere{1}, {0, 0, 0})};
  scene.bodies[2].fixed = true;
  const System system(scene);
  BodyTable state(3);
  set_initial_state(scene, state.columns());
  const BodyColumns now = std::as_const(state).columns();
  MassWeightedProjection least(system);

  // The free ball alone gives way, along the line between the two.
  const ProjectionTarget possible{
      .a = 0, .b = 1, .arm_a = {0, 0, -1}, .arm_b = {0, 0, 0}, .direction = {0, 0, 1}, .amount = 0.5};
  const auto motion = least.project(now, {possible});
  BOOST_TEST((motion[0].head<3>() - Vec3(0, 0, 0.5)).norm() < 1e-12);  // what four rounds leave of a part in 1e6
  BOOST_TEST(least.take_solver_warning() == "");
  BOOST_TEST(least.project(now, {}).at(0).isZero(0));
  BOOST_TEST(least.take_solver_warning() == "");

  ProjectionTarget between_fixed = possible;
  between_fixed.a = 2;
  for (const PoseStep& step : least.project(now, {between_fixed})) BOOST_TEST(step.isZero(0));
  BOOST_TEST(least.take_solver_warning().find("singular") != std::string::npos);
  BOOST_TEST(least.take_solver_warning() == "");

  ProjectionTarget lost = possible;
  lost.amount = std::nan("");
  for (const PoseStep& step : least.project(now, {lost})) BOOST_TEST(step.isZero(0));
  BOOST_TEST(least.take_solver_warning().find("singular") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
