#include "cases/runner/trials/trials.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>

#include "cases/case/recording/recording_reader.h"
#include "cases/report/html/playback.h"
#include "cases/report/wording/recorded_error.h"
#include "cases/results/result_json.h"
#include "cases/results/trial_results.h"
#include "cases/truth/recorded/recorded_motion.h"
#include "core/base/json.h"
#include "tests/cases/recorded_case.h"
#include "tests/core/scene/toml/refusal.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_trials)

namespace {

using RecordersOf = std::function<Recorders(const Results& grid)>;

Results results_of(const std::string& path, const std::string& run = "core:velocity-verlet",
                   const RecordersOf& recorders = {}) {
  const Case definition = read_case(path, "slide", test::words());
  Results grid =
      plan_grid({definition}, {parse_run_name(run, test::words().engines)}, engines(), {.stable_steps = false});
  GridOptions options;
  options.stable_steps = options.is_thorough = false;
  if (recorders) options.recorders = recorders(grid);
  run_grid(grid, engines(), options, [](std::size_t, std::size_t) {});
  return grid;
}

// Keeps the start of each run's first body along x, as a text.
class StartRecorder : public Recorder {
 public:
  explicit StartRecorder(bool keeps_each_trial) : keeps_each_trial_(keeps_each_trial) {}
  std::string name() const override { return keeps_each_trial_ ? "each" : "first"; }
  Recording of_truth(const Case& definition, const Truth&, const TruthFacts&) const override {
    return {std::to_string(definition.scene.bodies[0].velocity.x())};
  }
  Recording of_run(const Case&, const Cell&, const JudgedRun& run, const std::vector<NamedSeries>&,
                   const TruthFacts&) const override {
    return {std::to_string(run.scene.bodies[0].velocity.x())};
  }
  bool keeps_each_trial() const override { return keeps_each_trial_; }
  void discard(const Cell&) const override {}
  bool still_has(const Cell&) const override { return true; }

 private:
  bool keeps_each_trial_;
};

}  // namespace

BOOST_AUTO_TEST_CASE(a_recorder_keeps_each_trial_if_it_says_so_and_else_the_first) {
  Folder folder;
  folder.write("slide.csv", test::sliding_recording(0.3, 3, 1));
  const Results grid = results_of(
      folder.write("slide.toml", test::recorded_case(0.4, "slide.csv")), "core:velocity-verlet", [](const Results&) {
        return Recorders{std::make_shared<StartRecorder>(true), std::make_shared<StartRecorder>(false)};
      });
  const auto& trials = grid.cases[0].definition.recording->trials;
  BOOST_TEST_REQUIRE(grid.cases[0].truth.has_value());
  for (const Recordings& kept : {grid.cases[0].cells[0].recordings, grid.cases[0].truth->recordings}) {
    for (std::size_t k = 0; k < trials.size(); ++k) {
      const std::string start = std::to_string(trials[k].bodies[0].velocities[0].x());
      BOOST_TEST_REQUIRE(kept.contains(recording_of_trial("each", k)));
      BOOST_TEST(kept.at(recording_of_trial("each", k)).front() == start);
      BOOST_TEST(kept.contains(recording_of_trial("first", k)) == (k == 0));
    }
  }
}

BOOST_AUTO_TEST_CASE(the_page_gets_a_motion_of_every_trial) {
  Folder folder;
  folder.write("slide.csv", test::sliding_recording(0.3, 3, 1));
  const Results grid =
      results_of(folder.write("slide.toml", test::recorded_case(0.4, "slide.csv")), "core:velocity-verlet",
                 [](const Results& planned) { return Recorders{std::make_shared<PlaybackRecorder>(planned)}; });
  const PlaybackChoice chosen(grid, 100'000);
  const Motions run = chosen.of(grid.cases[0], grid.cases[0].cells[0]), truth = chosen.of_truth(grid.cases[0]);
  for (const Motions& motions : {run, truth}) {
    BOOST_TEST_REQUIRE(motions.size() == 3u);
    for (const std::string& motion : motions) BOOST_TEST(!motion.empty());
    BOOST_TEST((motions[0] != motions[1] && motions[1] != motions[2]));
  }
  // Of a small page each trial takes about an equal share.
  const PlaybackChoice few(grid, 2000);
  std::size_t sum = 0;
  for (const Motions& motions : {few.of(grid.cases[0], grid.cases[0].cells[0]), few.of_truth(grid.cases[0])})
    for (const std::string& motion : motions) {
      BOOST_TEST(!motion.empty());
      sum += motion.size();
    }
  BOOST_TEST(sum <= 2000u);
}

BOOST_AUTO_TEST_CASE(each_trial_runs_from_its_own_start_and_the_mean_is_over_them) {
  Folder folder;
  folder.write("slide.csv", test::sliding_recording(0.3, 4, 1));
  const Results grid = results_of(folder.write("slide.toml", test::recorded_case(0.4, "slide.csv")));
  const Cell& cell = grid.cases[0].cells[0];
  BOOST_TEST_CONTEXT(cell.reason) { BOOST_TEST_REQUIRE((cell.status == Status::pass)); }
  const std::vector<TrialResult> trials = trials_of(cell);
  BOOST_TEST_REQUIRE(trials.size() == 4u);
  BOOST_TEST(trials[2].name == "t2");
  // Too much friction by 0.1: after t it lags g t²/20. The mean over 0.2 s is a third of that at the end, 6.5 mm: 1.6 %
  // of 0.4 m, and the mean of 40 samples is 1.9 % more. The noise adds less than 1 % to so large a distance.
  double sum = 0, worst = 0;
  std::string name;
  for (const TrialResult& trial : trials) {
    const double error = trial.metrics.at("mean_position_error");
    BOOST_TEST(std::abs(error - 100 * 9.81 * 0.1 * 0.04 / 6 / 0.4 * 1.038) < 0.05);
    sum += error;
    if (error > worst) worst = error, name = trial.name;
  }
  BOOST_TEST(std::abs(cell.metrics.at("mean_position_error").value - sum / 4) < 1e-12);
  const auto spread = spread_over(trials, "mean_position_error");
  BOOST_TEST_REQUIRE(spread.has_value());
  BOOST_TEST(spread->worst == name);
  BOOST_TEST(spread->worst_value == worst);
  BOOST_TEST(spread->standard_deviation > 0);
  const TextTable table = recorded_errors(grid, grid.cases[0]);
  BOOST_TEST_REQUIRE(table.rows.size() == 2u);
  BOOST_TEST(table.rows[1][2].find(" ± ") != std::string::npos);
  BOOST_TEST(table.rows[1][4].find(" in " + name) != std::string::npos);
}

BOOST_AUTO_TEST_CASE(nothing_is_judged_below_the_noise) {
  Folder folder;
  folder.write("slide.csv", test::sliding_recording(0.3, 3, 1));
  const Results grid = results_of(folder.write("slide.toml", test::recorded_case(0.3, "slide.csv")));
  for (const TrialResult& trial : trials_of(grid.cases[0].cells[0])) {
    const double noise = 100 * 1.5957691216057308 * test::kPositionNoise / 0.4;
    BOOST_TEST(trial.metrics.at("mean_position_error") >= noise);
    BOOST_TEST(trial.metrics.at("mean_position_error") < 1.2 * noise);
    BOOST_TEST(!trial.metrics.contains("position_error"));  // it asks for a truth to a micrometre
  }
}

BOOST_AUTO_TEST_CASE(results_keep_the_trials) {
  Folder folder;
  folder.write("slide.csv", test::sliding_recording(0.3, 3, 1));
  const Results grid = results_of(folder.write("slide.toml", test::recorded_case(0.4, "slide.csv")));
  const Json json = json_of(grid.cases[0].cells[0], grid.cases[0].definition.scene);
  BOOST_TEST(json.at("trials").size() == 3u);
  BOOST_TEST(json.at("trials").at(1).at("trial") == "t1");
  const Json& trials = json.at("metrics").at("mean_position_error").at("trials");
  BOOST_TEST(trials.at("count") == 3);
  BOOST_TEST(trials.at("worst").at("value").get<double>() >= trials.at("median").get<double>());
}

BOOST_AUTO_TEST_CASE(a_missing_file_makes_the_case_unsupported_and_says_where_it_is_published) {
  Folder folder;
  const Results grid = results_of(folder.write("slide.toml", test::recorded_case(0.3, "elsewhere.csv")));
  const Cell& cell = grid.cases[0].cells[0];
  BOOST_TEST((cell.status == Status::unsupported));
  BOOST_TEST(cell.reason.find("RIGOR_DATA") != std::string::npos);
  BOOST_TEST(cell.reason.find("made by a test") != std::string::npos);
  BOOST_TEST(grid.cases[0].error == "");
}

BOOST_AUTO_TEST_CASE(the_folder_of_data_has_what_does_not_stand_beside_the_case) {
  Folder folder, data;
  data.write("slide.csv", test::sliding_recording(0.3, 2, 1));
  const std::string path = folder.write("slide.toml", test::recorded_case(0.3, "slide.csv"));
  ::setenv("RIGOR_DATA", data.path.c_str(), 1);
  const Case definition = read_case(path, "slide", test::words());
  const auto recording = definition.recording;
  ::unsetenv("RIGOR_DATA");
  BOOST_TEST_REQUIRE(recording != nullptr);
  BOOST_TEST(recording->trials.size() == 2u);
  BOOST_TEST((definition.scene.bodies[0].velocity == recording->trials[0].bodies[0].velocities[0]));
  BOOST_TEST(missing_recording(definition) == "");
  BOOST_TEST(missing_recording(read_case(path, "slide", test::words())) != "");
}

BOOST_AUTO_TEST_CASE(bad_keys_are_refused_with_their_place) {
  Folder folder;
  folder.write("slide.csv", test::sliding_recording(0.3, 2, 1));
  const auto refusal = [&](const std::string& from, const std::string& to) {
    std::string text = test::recorded_case(0.3, "slide.csv");
    text.replace(text.find(from), from.size(), to);
    const std::string path = folder.write("slide.toml", text);
    return refusal_of([&] { read_case(path, "slide", test::words()); });
  };
  const auto says = [&](const std::string& message, const std::string& part) {
    BOOST_TEST_CONTEXT(message) { BOOST_TEST((message.find(part) != std::string::npos)); }
  };
  says(refusal("position_noise = 0.0001", "position_noise = 0"), "slide.toml:24:18: truth.position_noise: found 0");
  says(refusal("length = 0.4", "piece = 0"), "truth.piece: found 0");
  says(refusal("length = 0.4", "piece = 3"), "truth.piece: found 3 s, and the longest trial lasts 0.2 s");
  says(refusal("length = 0.4", "piece = 0.05"), "ends after 0.05 s, and the run after 0.2 s");
  says(refusal("duration = 0.2", "duration = 0.3"), "ends after 0.2 s, and the run after 0.3 s");
  says(refusal("kind = \"recording\"", "kind = \"sliding\""), "truth.file: a computed truth has no file");
  says(refusal("group = \"trial\"", "group = \"trail\""), "did you mean 'trial'?");
  says(refusal("length = 0.4", "length = -1"), "truth.length: found -1");
  says(refusal("length = 0.4", "start_fit = 100"), "found 100, and trial 't0' has 41 samples");
  says(refusal("length = 0.4", "start_fit = 3"), "a whole number from 4 to 10000");
  says(refusal("slide.csv", "../slide.csv"), "not in the case file's folder");
}

// Each of two trials of 0.2 s makes two pieces of 0.1 s. Friction that is a third too large makes a quarter of the
// error in half the time.
BOOST_AUTO_TEST_CASE(pieces_of_trials_are_trials_with_starts_of_their_own) {
  Folder folder;
  folder.write("slide.csv", test::sliding_recording(0.3, 2, 1));
  std::string text = test::recorded_case(0.4, "slide.csv") + "piece = 0.1\n";
  text.replace(text.find("duration = 0.2"), 14, "duration = 0.1");
  const Results grid = results_of(folder.write("slide.toml", text));
  const Cell& cell = grid.cases[0].cells[0];
  BOOST_TEST_CONTEXT(cell.reason) { BOOST_TEST_REQUIRE((cell.status == Status::pass)); }
  const std::vector<TrialResult> trials = trials_of(cell);
  BOOST_TEST_REQUIRE(trials.size() == 4u);
  BOOST_TEST(trials[1].name == "t0 from 0.1 s");
  for (const TrialResult& trial : trials) {
    // As above, over 20 samples: 3.8 % more becomes 7.7 %. The noise of 0.1 mm is a tenth of the error, and the start's
    // is in it.
    BOOST_TEST(std::abs(trial.metrics.at("mean_position_error") - 100 * 9.81 * 0.1 * 0.01 / 6 / 0.4 * 1.077) < 0.08);
  }
}

BOOST_AUTO_TEST_CASE(noise_that_is_not_stated_is_estimated_and_said_to_be) {
  Folder folder;
  folder.write("slide.csv", test::sliding_recording(0.3, 6, 1));
  std::string text = test::recorded_case(0.3, "slide.csv");
  for (const char* const key : {"position_noise = 0.0001", "orientation_noise = 0.001"})
    text.replace(text.find(key), std::string(key).size(), "");
  const Case definition = read_case(folder.write("slide.toml", text), "slide", test::words());
  BOOST_TEST(definition.recording->is_noise_estimated);
  // 198 windows overlap and are worth some 25 independent ones of 18 degrees of freedom, which gives it to 3 % or so.
  BOOST_TEST(definition.recording->position_noise == test::kPositionNoise, boost::test_tools::tolerance(0.12));
  BOOST_TEST(definition.recording->orientation_noise == 0.001, boost::test_tools::tolerance(0.12));
  BOOST_TEST(truth_of(definition, 0.2)->caveat().find("estimated") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(runs_of_the_engine_that_made_a_synthetic_recording_are_no_witness) {
  Folder folder;
  folder.write("slide.csv", test::sliding_recording(0.3, 2, 1));
  const std::string text = test::recorded_case(0.3, "slide.csv") + "synthetic = \"core\"\n";
  const Results grid = results_of(folder.write("slide.toml", text));
  BOOST_TEST(grid.cases[0].cells[0].metrics.at("mean_position_error").is_held_to_itself);
}

BOOST_AUTO_TEST_SUITE_END()
