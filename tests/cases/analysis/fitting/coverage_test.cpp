// How often the 95 % intervals of `rigor fit` hold the value with which a recording was made. RIGOR_COVERAGE=200
// repeats each row so often and prints the share; RIGOR_COVERAGE_OF=spring selects a row.
#include <boost/test/unit_test.hpp>
#include <cstdlib>

#include "cases/analysis/fitting/fitting.h"
#include "tests/cases/noisy_recording.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_fitting_coverage)

namespace {

struct Known {
  std::string name, scene, vary;
  double value;
  int trials = 1;
  bool has_noise = true;  // stated
};

std::string run_of(double duration, double dt) { return fmt::format("[run]\nduration = {}\ndt = {}\n", duration, dt); }

std::string scene_of(const std::string& gravity, const std::string& body, const std::string& rest) {
  return fmt::format(
      "title = \"Made by a test\"\nsource = \"a test\"\n[scene]\ngravity = {}\n[[scene.body]]\nname = "
      "\"body\"\n{}\n{}\n",
      gravity, body, rest);
}

std::string bouncing() {
  return scene_of(
      "[0, 0, -9.81]",
      "mass = 1\nposition = [0, 0, 0.5]\nvelocity = [0.3, 0, 0]\nshape = { type = \"sphere\", radius = 0.1 }",
      "[[scene.body]]\nname = \"ground\"\nshape = { type = \"plane\", normal = [0, 0, 1], offset = 0 }\n"
      "[scene.contact_default]\nrestitution = 0.7\nfriction = 0\n" +
          run_of(0.8, 0.01));
}

std::string tumbling() {
  return scene_of("[0, 0, 0]",
                  "mass = 1\ninertia = [0.01, 0.02, 0.025]\nangular_velocity = [1, 3, 0.5]\n"
                  "shape = { type = \"sphere\", radius = 0.1 }\ncollides = false",
                  run_of(2, 0.02));
}

std::string on_a_spring() {
  return scene_of("[0, 0, -9.81]",
                  "mass = 1\nposition = [0.05, 0, -1.1]\nshape = { type = \"sphere\", radius = 0.1 }\ncollides = false",
                  "[[scene.spring]]\na = \"world\"\npoint_a = [0, 0, 0]\nb = \"body\"\npoint_b = [0, 0, 0]\n"
                  "stiffness = 100\nrest_length = 1\n" +
                      run_of(1, 0.01));
}

std::string on_a_rubbing_hinge() {
  return scene_of("[0, -9.81, 0]",
                  "mass = 1\ninertia = [0.01, 0.01, 0.01]\nposition = [0.4, -0.3, 0]\n"
                  "shape = { type = \"sphere\", radius = 0.1 }\ncollides = false",
                  "[[scene.joint]]\nname = \"pivot\"\ntype = \"hinge\"\na = \"world\"\nb = \"body\"\n"
                  "anchor = [0, 0, 0]\naxis = [0, 0, 1]\nfriction = 0.3\n" +
                      run_of(1, 0.01));
}

std::vector<Known> known() {
  const std::string friction = "scene.contact_default.friction=0.05..0.9";
  return {{"friction", test::sliding_scene(0.3), friction, 0.3},
          {"restitution", bouncing(), "scene.contact_default.restitution=0.3..0.95", 0.7},
          {"inertia", tumbling(), "scene.body.body.inertia[1]=0.016..0.024", 0.02},
          {"spring", on_a_spring(), "scene.spring[0].stiffness=50..200", 100},
          {"joint-friction", on_a_rubbing_hinge(), "scene.joint.pivot.friction=0.05..0.9", 0.3},
          {"estimated-noise", test::sliding_scene(0.3), friction, 0.3, 1, false},
          {"bootstrap", test::sliding_scene(0.3), friction, 0.3, 8}};
}

FitResult fitted(const Known& row, unsigned long seed) {
  Folder folder;
  folder.write("run.csv", test::noisy_recording(row.scene, row.trials, seed, row.trials > 1 ? 0.2 : 0));
  const std::string path = folder.write("case.toml", row.scene + test::noisy_truth("run.csv", row.has_noise));
  FitInput input;
  input.cases = {read_case(path, "case", test::words())};
  input.run = parse_run_name("core:velocity-verlet", test::words().engines);
  input.axes = {parse_axis(row.vary, true)};
  input.jobs = 2, input.seed = seed;
  return fit(input, engines(), test::words());
}

}  // namespace

BOOST_AUTO_TEST_CASE(intervals_hold_the_known_value_as_often_as_they_say) {
  const char *asked = std::getenv("RIGOR_COVERAGE"), *only = std::getenv("RIGOR_COVERAGE_OF");
  const unsigned long count = asked ? std::strtoul(asked, nullptr, 10) : 3;
  for (const Known& row : known()) {
    if (only && row.name != only) continue;
    unsigned long covered = 0, widened = 0;
    double width = 0;
    for (unsigned long seed = 1; seed <= count; ++seed) {
      const FitResult found = fitted(row, seed);
      const FittedParameter& value = found.parameters.at(0);
      BOOST_TEST_REQUIRE(value.interval.has_value(), row.name << ": " << found.why_no_intervals << value.unknown);
      BOOST_TEST(found.method == (row.trials > 1 ? "bootstrap" : "profile"));
      const bool holds = value.interval->first <= row.value && row.value <= value.interval->second;
      covered += holds, widened += !found.caveats.empty();
      width += (value.interval->second - value.interval->first) / static_cast<double>(count);
    }
    BOOST_TEST_MESSAGE(fmt::format("{}: {} of {} intervals hold {}, mean width {:.3g}, {} with a caveat", row.name,
                                   covered, count, row.value, width, widened));
    // Two hundred repetitions of 95 % have a standard error of 1.5 %. At least one of three holds, else the chance was
    // one in ten thousand.
    const double share = static_cast<double>(covered) / static_cast<double>(count);
    BOOST_TEST(share >= (count >= 200 ? 0.92 : 0.3), row.name);
    if (count >= 200) BOOST_TEST(share <= 0.98, row.name);
  }
}

BOOST_AUTO_TEST_SUITE_END()
