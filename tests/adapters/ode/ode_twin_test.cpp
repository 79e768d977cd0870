// ODE's joints against their twin, row by row; how twins fare over the whole suite stands in twins_test.cpp.
#include "adapters/ode/ode_twin.h"

#include <boost/test/unit_test.hpp>

#include "cases/runner/twin_run.h"
#include "tests/adapters/free_body_measures.h"
#include "tests/adapters/ode/jointed_scenes.h"
#include "tests/adapters/seam_runs.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_ode_ode_twin)

namespace {

// The largest difference of any component of position, of orientation [rad] and of the velocities, after 100 steps.
double difference_after(const std::string& one, const std::string& other, const Scene& scene) {
  const auto a = load_run(one, scene), b = load_run(other, scene);
  const BodyTable left = state_after(*a, 1.0 / 120, 100), right = state_after(*b, 1.0 / 120, 100);
  BOOST_TEST(b->solver_warning() == "");
  double largest = 0;
  for (std::size_t i = 0; i < left.size(); ++i) {
    const BodyState x = left.columns().body(i), y = right.columns().body(i);
    largest = std::max({largest, (x.position - y.position).norm(), angle_between(x.orientation, y.orientation),
                        (x.velocity - y.velocity).norm(), (x.angular_velocity - y.angular_velocity).norm()});
  }
  return largest;
}

std::string twin_name(const std::string& run, const Scene& scene) {
  const auto twin = twin_of(engines(), parse_run_name(run, infos_of(engines())), scene);
  return twin ? twin->text : "";
}

}  // namespace

// Positions to 8 m, speeds to 15 m/s: roundings of 2e-15 in each of a hundred steps, which joints magnify by up to a
// hundred.
constexpr double kRounding = 2e-11;

BOOST_AUTO_TEST_CASE(every_kind_of_joint_is_repeated_to_rounding) {
  double largest = 0;
  for (const auto& [name, scene] : test::jointed_scenes()) {
    for (const char* run : {"ode:worldstep", "ode:worldstep@stock", "ode:worldstep,erp=0.9,cfm=1e-6",
                            "ode:worldstep,gyroscopic=off,rotation=infinitesimal"}) {
      const std::string twin = twin_name(run, scene);
      BOOST_TEST_REQUIRE(twin != "");
      const double found = difference_after(run, twin, scene);
      largest = std::max(largest, found);
      BOOST_TEST(found < kRounding, name << ", " << run << ": " << found);
    }
  }
  BOOST_TEST_MESSAGE("at most " << largest);
}

// Whose rows do not change as it moves: no gap opens that a share could be closed of.
bool has_no_gap(const Scene& scene) {
  const bool straight = std::holds_alternative<SliderJoint>(scene.joints[0].type) ||
                        std::holds_alternative<FixedJoint>(scene.joints[0].type);
  return straight && scene.bodies.size() == 1;
}

// An erp or cfm that is not the engine's must be seen, if it is off by a hundredth of itself.
BOOST_AUTO_TEST_CASE(a_wrong_erp_or_cfm_is_noticed) {
  for (const auto& [name, scene] : test::jointed_scenes()) {
    if (!has_no_gap(scene))
      BOOST_TEST(difference_after("ode:worldstep,erp=0.5", "core:ode-twin,erp=0.495", scene) > 1e-7, name);
    BOOST_TEST(difference_after("ode:worldstep,cfm=0.01", "core:ode-twin,cfm=0.0099", scene) > 1e-7, name);
  }
}

BOOST_AUTO_TEST_CASE(what_is_not_repeated_has_no_twin) {
  Scene scene = test::with_joint(HingeJoint{{0.3, 0.1, 0.2}, Vec3(2, -1, 2) / 3}, test::Ends::from_world);
  BOOST_TEST(twin_name("ode", scene) == "core:ode-twin,gyroscopic=on,rotation=finite,erp=0.5,joints=direct");
  BOOST_TEST(twin_name("ode@stock", scene) ==
             "core:ode-twin,gyroscopic=on,rotation=infinitesimal,erp=0.2,cfm=1e-10,joints=direct");
  BOOST_TEST(twin_name("ode:quickstep", scene) == "");
  scene.joints[0].upper = 1;
  BOOST_TEST(twin_name("ode", scene) == "");
  scene.joints.clear();
  BOOST_TEST(twin_name("ode:quickstep", scene) != "");
}

BOOST_AUTO_TEST_SUITE_END()
