#include "cases/analysis/fitting/fitting.h"

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include "tests/cases/noisy_recording.h"
#include "tests/core/scene/toml/refusal.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_fitting_fitting)

namespace {

const std::string kFriction = "scene.contact_default.friction";

FitInput input_of(const Folder& folder, const std::vector<std::string>& vary, double friction_of_case = 0.5,
                  const std::string& run = "core:velocity-verlet") {
  FitInput input;
  const std::string path = folder.write("slide.toml", test::recorded_case(friction_of_case, "slide.csv"));
  input.cases = {read_case(path, "slide", test::words())};
  input.run = parse_run_name(run, test::words().engines);
  for (const std::string& text : vary) input.axes.push_back(parse_axis(text, true));
  input.jobs = 2;
  return input;
}

FitResult fitted(const FitInput& input) { return fit(input, engines(), test::words()); }

}  // namespace

BOOST_AUTO_TEST_CASE(gives_a_known_friction_back_within_its_interval) {
  Folder folder;
  folder.write("slide.csv", test::sliding_recording(0.3, 8, 1));
  FitInput input = input_of(folder, {kFriction + "=0.05..0.9"});
  input.hold_out = 0.25;
  const FitResult found = fitted(input);
  const FittedParameter& friction = found.parameters.at(0);
  BOOST_TEST_REQUIRE(friction.interval.has_value());
  BOOST_TEST(friction.interval->first <= 0.3);
  BOOST_TEST(friction.interval->second >= 0.3);
  // 40 samples of 0.1 mm noise over a way of mu g t²/2 = 0.059 m: a percent at most.
  BOOST_TEST(friction.interval->second - friction.interval->first < 0.003);
  BOOST_TEST(std::abs(friction.number - 0.3) < 0.003);
  BOOST_TEST(friction.unknown == "");
  BOOST_TEST(!friction.is_at_bound);
  BOOST_TEST(found.training.trials == 6u);
  BOOST_TEST_REQUIRE(found.held_out.has_value());
  BOOST_TEST(found.held_out->trials == 2u);
  // Noise alone: 1.6 times 0.1 mm of 0.4 m, and of 1e-3 rad. Ten per cent for 80 samples.
  BOOST_TEST(std::abs(found.held_out->position - 0.0399) < 0.004);
  BOOST_TEST(std::abs(found.held_out->rotation - 0.0914) < 0.009);
}

BOOST_AUTO_TEST_CASE(repeats_with_its_seed_and_with_any_number_of_jobs) {
  Folder folder;
  folder.write("slide.csv", test::sliding_recording(0.3, 5, 1));
  FitInput input = input_of(folder, {kFriction + "=0.05..0.9"});
  const FitResult first = fitted(input);
  input.jobs = 1;
  const FitResult second = fitted(input);
  BOOST_TEST(first.parameters[0].value == second.parameters[0].value);
  BOOST_TEST((first.parameters[0].interval == second.parameters[0].interval));
  BOOST_TEST(first.points == second.points);
}

BOOST_AUTO_TEST_CASE(says_what_the_data_cannot_tell) {
  Folder folder;
  folder.write("slide.csv", test::sliding_recording(0.3, 6, 2));
  // A block that slides on a plane goes its way with any mass: friction and inertia force are both proportional to it.
  const FitResult found = fitted(input_of(folder, {kFriction + "=0.05..0.9", "scene.body.block.mass=0.5..2"}));
  BOOST_TEST(found.parameters[0].unknown == "");
  BOOST_TEST(found.parameters[1].unknown != "");
  BOOST_TEST(!found.parameters[1].interval.has_value());
  // The start comes from the recording.
  const FitResult start = fitted(input_of(folder, {"scene.body.block.velocity[1]=-1..1"}));
  BOOST_TEST(start.parameters[0].unknown == "it changes nothing here");
}

BOOST_AUTO_TEST_CASE(says_that_a_value_is_at_the_end_of_its_range) {
  Folder folder;
  folder.write("slide.csv", test::sliding_recording(0.3, 6, 2));
  const FitResult found = fitted(input_of(folder, {kFriction + "=0.4..0.9"}));
  BOOST_TEST(found.parameters[0].is_at_bound);
  BOOST_TEST(std::abs(found.parameters[0].number - 0.4) < 0.001);
}

// Along its way the block is at x + v t - mu g t²/2. Least squares of such a parabola, with x and v unknown, have this
// standard error of mu.
double standard_error_of_friction(double noise) {
  constexpr long kSamples = 41;
  Eigen::MatrixXd powers(kSamples, 3);
  for (long n = 0; n < kSamples; ++n) {
    const double t = 0.005 * static_cast<double>(n);
    powers.row(n) << 1, t, 0.5 * 9.81 * t * t;
  }
  const Eigen::Matrix3d covariance = (powers.transpose() * powers).inverse();
  return noise * std::sqrt(covariance(2, 2));
}

BOOST_AUTO_TEST_CASE(one_trial_has_the_interval_of_its_parabola) {
  Folder folder;
  for (const unsigned long seed : {1, 2, 3}) {
    folder.write("slide.csv", test::noisy_recording(test::sliding_scene(0.3), 1, seed));
    const FitResult found = fitted(input_of(folder, {kFriction + "=0.05..0.9"}));
    BOOST_TEST(found.method == "profile");
    BOOST_TEST(found.why_no_intervals == "");
    const FittedParameter& friction = found.parameters[0];
    BOOST_TEST_REQUIRE(friction.interval.has_value());
    const double due = 1.96 * standard_error_of_friction(test::kPositionNoise);
    const double half = 0.5 * (friction.interval->second - friction.interval->first);
    // Orientations tell some of it, too, as friction tilts a block that does not lie flat.
    BOOST_TEST(std::abs(half / due - 1) < 0.05);
    BOOST_TEST(std::abs(friction.number - 0.3) < 3 * due / 1.96);
    BOOST_TEST(!friction.is_low_open);
    BOOST_TEST(!friction.is_high_open);
  }
}

// Another law than the recorded one: a spring, whose force grows with the way, pulls the block, too. With 10 N/m the
// best parabola leaves up to 0.25 mm along the way, 1.8 times the noise over all components; with 100 N/m ten times
// that.
BOOST_AUTO_TEST_CASE(one_trial_that_the_engine_cannot_follow_has_a_caveat_or_no_interval) {
  Folder folder;
  const auto fitted_to = [&](double stiffness) {
    std::string scene = test::sliding_scene(0.3);
    scene.insert(scene.find("[scene.contact_default]"),
                 fmt::format("[[scene.spring]]\na = \"world\"\npoint_a = [0, 0, 0.05]\nb = \"block\"\n"
                             "point_b = [0, 0, 0]\nstiffness = {}\n",
                             stiffness));
    folder.write("slide.csv", test::noisy_recording(scene, 1, 1));
    return fitted(input_of(folder, {kFriction + "=0.05..0.9"}));
  };
  const FitResult near = fitted_to(10);
  BOOST_TEST(near.why_no_intervals == "");
  BOOST_TEST_REQUIRE(!near.caveats.empty());
  BOOST_TEST(near.caveats[0].find("positions") != std::string::npos);
  const FitResult far = fitted_to(100);
  BOOST_TEST(far.why_no_intervals.find("as far away as the noise explains") != std::string::npos);
  BOOST_TEST(!far.parameters[0].interval.has_value());
}

BOOST_AUTO_TEST_CASE(one_trial_says_what_it_cannot_tell) {
  Folder folder;
  folder.write("slide.csv", test::noisy_recording(test::sliding_scene(0.3), 1, 2));
  const FitResult found = fitted(input_of(folder, {kFriction + "=0.05..0.9", "scene.body.block.mass=0.5..2"}));
  BOOST_TEST(found.parameters[0].unknown == "");
  BOOST_TEST(found.parameters[1].unknown != "");
  BOOST_TEST(!found.parameters[1].interval.has_value());
}

BOOST_AUTO_TEST_CASE(one_trial_has_a_one_sided_interval_at_a_bound) {
  Folder folder;
  folder.write("slide.csv", test::noisy_recording(test::sliding_scene(0.3), 1, 2));
  const double due = 1.96 * standard_error_of_friction(test::kPositionNoise);
  const FitResult found = fitted(input_of(folder, {kFriction + fmt::format("={}..0.9", 0.3 + due)}));
  const FittedParameter& friction = found.parameters[0];
  BOOST_TEST_REQUIRE(friction.interval.has_value());
  BOOST_TEST(friction.is_low_open);
  BOOST_TEST(!friction.is_high_open);
  BOOST_TEST(friction.interval->first == 0.3 + due, boost::test_tools::tolerance(1e-9));
}

// One trial of another world must not move the value: its error counts little.
BOOST_AUTO_TEST_CASE(a_trial_that_nothing_explains_counts_little) {
  Folder folder;
  std::string text = test::sliding_recording(0.3, 8, 3);
  std::string other = test::sliding_recording(0.8, 1, 4);
  other = other.substr(other.find('\n') + 1);
  for (std::size_t at = 0; (at = other.find("t0,", at)) != std::string::npos; at += 7) other.replace(at, 3, "other,");
  folder.write("slide.csv", text + other);
  const FitResult found = fitted(input_of(folder, {kFriction + "=0.05..0.9"}));
  BOOST_TEST(std::abs(found.parameters[0].number - 0.3) < 0.01);
}

BOOST_AUTO_TEST_CASE(a_computed_truth_is_that_of_the_case_as_written) {
  FitInput input;
  const std::string text = test::sliding_scene(0.3) + "[truth]\nkind = \"sliding\"\n";
  input.cases = {read_case_text(text, "slide.toml", "slide", test::words())};
  input.run = parse_run_name("core:velocity-verlet", test::words().engines);
  input.axes = {parse_axis(kFriction + "=0.05..0.9", true)};
  const FitResult found = fitted(input);
  BOOST_TEST(std::abs(found.parameters[0].number - 0.3) < 1e-3);
  BOOST_TEST(found.why_no_intervals != "");
}

BOOST_AUTO_TEST_CASE(bad_input_is_refused_with_a_near_match) {
  Folder folder;
  folder.write("slide.csv", test::sliding_recording(0.3, 2, 2));
  const auto refusal = [&](const std::string& vary, double hold_out = 0) {
    return refusal_of([&] {
      FitInput input = input_of(folder, {vary});
      input.hold_out = hold_out;
      fitted(input);
    });
  };
  BOOST_TEST(refusal("scene.contact_default.fricton=0.1..0.9").find("did you mean 'friction'?") != std::string::npos);
  BOOST_TEST(refusal("contcat=0.1..0.9").find("did you mean 'contact'?") != std::string::npos);
  BOOST_TEST(refusal("duration=0.1..0.2").find("cannot be fitted") != std::string::npos);
  BOOST_TEST(refusal(kFriction + "=0.1,0.2").find("allowed: a range") != std::string::npos);
  BOOST_TEST(refusal(kFriction + "=-0.5..0.2").find("friction") != std::string::npos);
  BOOST_TEST(refusal(kFriction + "=0.1..0.9", 0.1).find("leaves one side") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
