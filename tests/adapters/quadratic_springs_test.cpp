// Springs whose stiffness grows with their extension, in every engine that says it takes them.
#include <set>

#include "core/scene/features/features.h"
#include "tests/adapters/seam_runs.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_quadratic_springs)

namespace {

// An extension of 0.5 pulls with (10 + 4 * 0.5) * 0.5 = 6 N or N m; without its second part it would pull with 5.
constexpr double kStiffness = 10, kQuadratic = 4, kExtension = 0.5, kEffort = 6;
constexpr double kStep = 1e-3;  // s

Scene at_rest() {
  Scene scene;
  scene.gravity.setZero();
  scene.bodies = {test::body("body", 2, {0.5, 0.5, 0.5}, {2, 0, 0})};
  return scene;
}

Scene between_points(double extension) {
  Scene scene = at_rest();
  scene.springs = {test::spring(kWorld, Vec3::Zero(), 0, Vec3::Zero(), kStiffness, 2 - extension)};
  scene.springs[0].quadratic_stiffness = kQuadratic;
  return scene;
}

template <typename Type>
Scene on_joint(const Type& type, double extension) {
  Scene scene = at_rest();
  scene.joints = {{.a = kWorld, .b = 0, .type = type, .stiffness = kStiffness, .rest = -extension}};
  scene.joints[0].quadratic_stiffness = kQuadratic;
  return scene;
}

// The rate along the coordinate that the spring pulls on, after some steps from rest. The stiffest slope is 14 on 0.5
// kg m²: 5.3 rad/s, so that ten steps of 1 ms change the force by a thousandth.
void check_pull(const Scene& scene, const std::function<double(const BodyState&)>& rate, double expected) {
  constexpr int kSteps = 10;
  for_each_run(scene, kStep, [&](const Run& run) {
    const auto world = run.load(scene);
    const BodyState end = states_of(state_after(*world, kStep, kSteps)).at(0);
    BOOST_TEST(std::abs(rate(end) / (kSteps * kStep) - expected) < 0.02 * std::abs(expected),
               rate(end) / (kSteps * kStep) << " for " << expected);
  });
}

}  // namespace

BOOST_AUTO_TEST_CASE(they_pull_and_push_with_their_law) {
  for (const double sign : {1.0, -1.0}) {
    const double x = sign * kExtension, pull = -sign * kEffort;
    check_pull(
        between_points(x), [](const BodyState& s) { return s.velocity.x(); }, pull / 2);
    check_pull(
        on_joint(SliderJoint{Vec3::UnitY()}, x), [](const BodyState& s) { return s.velocity.y(); }, pull / 2);
    check_pull(
        on_joint(HingeJoint{{2, 0, 0}, Vec3::UnitZ()}, x), [](const BodyState& s) { return s.angular_velocity.z(); },
        pull / 0.5);
  }
}

BOOST_AUTO_TEST_CASE(engines_without_them_say_so) {
  std::set<std::string> with, without;
  for (const Run& run : all_runs())
    (run.supports(between_points(kExtension), kStep) ? with : without).insert(run.info.name);
  for (const char* name : {"core", "ode", "bullet"}) BOOST_TEST(with.contains(name), name);
  for (const char* name : {"mujoco", "mujoco3"}) BOOST_TEST(!with.contains(name), name);
  for (const Run& run : all_runs()) {
    if (run.info.name != "mujoco") continue;
    const std::string why = why_unsupported(run.info, run.settings, between_points(kExtension), kStep);
    BOOST_TEST(why.find("quadratic-spring") != std::string::npos, why);
  }
}

BOOST_AUTO_TEST_SUITE_END()
