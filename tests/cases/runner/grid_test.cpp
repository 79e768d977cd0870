#include "cases/runner/grid.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <set>
#include <thread>

#include "cases/case/run_selector.h"
#include "cases/report/csv/trajectory_csv.h"
#include "cases/results/result_json.h"
#include "cases/runner/process_pool.h"
#include "core/base/error.h"
#include "tests/cases/runner/faulty_engine.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_grid)

namespace {

void sit_still(double&) {}

void spin() {
  volatile bool is_spinning = true;
  while (is_spinning) {
  }
}

// The pipe for the answers of a cell's process: among Rigor's writable pipes other than its output, the newest.
int pipe_of_answers() {
  struct stat printed {
  }, about{};
  fstat(STDOUT_FILENO, &printed);
  int found = -1;
  for (int descriptor = STDERR_FILENO + 1; descriptor < 256; ++descriptor) {
    if (fstat(descriptor, &about) != 0 || !S_ISFIFO(about.st_mode) || about.st_ino == printed.st_ino) continue;
    if (fcntl(descriptor, F_GETFD) != FD_CLOEXEC) continue;  // what the test itself was started with
    if ((fcntl(descriptor, F_GETFL) & O_ACCMODE) == O_WRONLY) found = descriptor;
  }
  return found;
}

// An engine whose memory errors write into its process's answers.
void answer_before_rigor_does(const std::string& text) { Channel(pipe_of_answers()).send(text); }

EngineTable faulty_engines(bool with_one_that_hangs = true) {
  EngineTable table;
  const auto add = [&](auto&&... parts) { table.add(std::make_unique<FaultyEngine>(parts...)); };
  add("aborts", [](double&) { std::fputs("solver: matrix is singular\n", stderr), std::abort(); });
  add("warns", sit_still, "Newton's iteration did not converge");
  add("exits", [](double&) { std::exit(0); });
  add("good", sit_still);
  if (with_one_that_hangs) add("hangs", [](double&) { spin(); });
  add("loses-numbers", [](double& x) { x = std::numeric_limits<double>::quiet_NaN(); });
  add("refuses", [](double&) { throw InputError("this scene is too small for me"); });
  add("segfaults", [](double&) { std::raise(SIGSEGV); });
  add("throws", [](double&) { throw std::runtime_error("no memory left for contacts"); });
  return table;
}

class HangingWithContacts : public FaultyEngine {
 public:
  HangingWithContacts() : FaultyEngine("hangs", [](double&) { spin(); }) {}
  EngineInfo info() const override {
    EngineInfo info = FaultyEngine::info();
    info.features =
        joined(contacts_of_all_shapes(), {Feature::restitution, Feature::friction_none, Feature::friction_coulomb});
    return info;
  }
};

std::vector<RunName> runs_of(const EngineTable& table) {
  std::vector<RunName> runs;
  for (const EngineInfo& info : infos_of(table)) runs.push_back(parse_run_name(info.name, infos_of(table)));
  return runs;
}

Results run(const std::vector<Case>& cases, const EngineTable& table, const GridOptions& options) {
  Results grid = plan_grid(cases, runs_of(table), table, {options.stable_steps});
  run_grid(grid, table, options, [](std::size_t, std::size_t) {});
  return grid;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_broken_engine_costs_its_own_cells_and_says_how) {
  const EngineTable table = faulty_engines();
  const Results grid = run({drifting_body("a"), drifting_body("b")}, table, {2, 0.5, {}, false});
  const std::map<std::string, std::pair<Status, std::string>> expected = {
      {"aborts", {Status::crashed, "SIGABRT"}},
      {"warns", {Status::invalid, "Newton's iteration did not converge"}},
      {"exits", {Status::crashed, "exit(0)"}},
      {"good", {Status::pass, ""}},
      {"hangs", {Status::timed_out, "0.5 s"}},
      {"loses-numbers", {Status::diverged, "stone"}},
      {"refuses", {Status::invalid, "too small for me"}},
      {"segfaults", {Status::crashed, "SIGSEGV"}},
      {"throws", {Status::crashed, "no memory left"}},
  };
  for (const CaseResult& result : grid.cases) {
    BOOST_TEST_REQUIRE(result.cells.size() == 2 * expected.size());
    for (const Cell& cell : result.cells) {
      const std::string& engine = grid.runs[cell.run].engine;
      BOOST_TEST(word_of(cell.status) == word_of(expected.at(engine).first), engine);
      BOOST_TEST(cell.reason.find(expected.at(engine).second) != std::string::npos, cell.reason);
    }
  }
  const Cell& aborted = grid.cases.front().cells.front();
  BOOST_TEST(aborted.reason.find("solver: matrix is singular") != std::string::npos, aborted.reason);
}

// A finer step would take longer; among bodies that can touch it may take less.
BOOST_AUTO_TEST_CASE(where_a_run_was_out_of_time_a_finer_step_is_not_tried) {
  EngineTable table;
  table.add(std::make_unique<HangingWithContacts>());
  Case touching = drifting_body("touching");
  touching.scene.bodies.push_back(touching.scene.bodies.front());
  touching.scene.bodies.back().name = "other", touching.scene.bodies.back().position = Vec3(5, 0, 0);
  for (Body& body : touching.scene.bodies) body.shape = Sphere{0.1}, body.collides = true;
  const Results grid = run({drifting_body("a"), touching}, table, {1, 0.1, {}, true});
  const std::string out_of_time = "no result within the limit of 0.1 s", not_tried = "not tried: at 1/10 s there was ";
  for (const CaseResult& result : grid.cases) {
    for (const Cell& cell : result.cells) BOOST_TEST((cell.status == Status::timed_out), word_of(cell.status));
    BOOST_TEST(result.cells[0].reason == out_of_time);
  }
  BOOST_TEST(grid.cases[0].cells[1].reason == not_tried + out_of_time + ", and this step takes longer");
  BOOST_TEST((grid.cases[0].stable_steps[0].status == Status::timed_out));
  BOOST_TEST(grid.cases[0].stable_steps[0].reason == not_tried + out_of_time);
  BOOST_TEST(grid.cases[1].cells[1].reason == out_of_time);
}

BOOST_AUTO_TEST_CASE(a_garbled_answer_costs_its_cell_and_no_other) {
  const Case definition = drifting_body("a");
  Cell passing;
  passing.status = Status::pass, passing.reason = "";
  const std::vector<std::pair<std::string, std::string>> garbled = {
      {"babbles", "{\"cell\":0, and so on"},
      {"is-of-no-status", "{\"cell\":2,\"result\":{\"status\":\"psas\",\"reason\":\"\"},\"playback\":[]}"},
      {"poses-as-another", message_of_cell(0, passing, definition.scene)},
      {"is-far-off", message_of_cell(9999, passing, definition.scene)},
      {"is-torn", message_of_cell(6, passing, definition.scene).substr(0, 40)},
  };
  EngineTable table;
  table.add(std::make_unique<FaultyEngine>("good", sit_still));
  for (const auto& [name, text] : garbled)
    table.add(std::make_unique<FaultyEngine>(name, [text](double&) { answer_before_rigor_does(text); }));
  const Results grid = run({definition}, table, {2, 20, {}, false});
  BOOST_TEST(grid.cases.front().error == "");
  for (const Cell& cell : grid.cases.front().cells) {
    const bool is_good = grid.runs[cell.run].engine == "good";
    BOOST_TEST((cell.status == (is_good ? Status::pass : Status::crashed)), grid.runs[cell.run].engine);
    if (!is_good) BOOST_TEST(cell.reason.find("its message could not be read") != std::string::npos, cell.reason);
  }
  for (const Spread& spread : grid.cases.front().spreads)
    BOOST_TEST(spread.first == spread.second);  // only one engine left a path
}

BOOST_AUTO_TEST_CASE(a_case_whose_process_is_stopped_ends) {
  EngineTable table;
  table.add(std::make_unique<FaultyEngine>("good", sit_still));
  table.add(std::make_unique<FaultyEngine>("stops-its-parent", [](double&) {
    kill(getppid(), SIGSTOP);
    pause();
  }));
  const Results grid = run({drifting_body("a"), drifting_body("b")}, table, {1, 0.1, {}, false});
  for (const CaseResult& result : grid.cases) {
    for (const Cell& cell : result.cells) {
      const bool is_good = grid.runs[cell.run].engine == "good";
      BOOST_TEST((cell.status == (is_good ? Status::pass : Status::timed_out)), word_of(cell.status) + cell.reason);
    }
    BOOST_TEST(result.error.find("broke off") != std::string::npos, result.error);
  }
}

BOOST_AUTO_TEST_CASE(results_do_not_depend_on_how_many_run_at_once) {
  const auto no_time = [](const Results& grid) {
    std::string text;
    for (const Cell& cell : grid.cases.front().cells) {
      text += grid.runs[cell.run].text + cell.dt.text + word_of(cell.status) + cell.reason +
              word_of(cell.stability.verdict);
      for (const auto& [name, metric] : cell.metrics) {
        if (name == "cost") continue;  // a measured time
        text += name + std::to_string(metric.value) + std::to_string(metric.worst.time) + metric.not_applicable;
      }
    }
    for (const Spread& spread : grid.cases.front().spreads) {
      text += grid.runs[spread.first].text + grid.runs[spread.second].text + spread.dt.text +
              std::to_string(spread.distance.value) + std::to_string(spread.compared_until);
    }
    return text;
  };
  const EngineTable table = faulty_engines(false);
  const std::string one = no_time(run({drifting_body("a")}, table, {1, 60, {}, false}));
  BOOST_TEST(one == no_time(run({drifting_body("a")}, table, {5, 60, {}, false})));
}

BOOST_AUTO_TEST_CASE(each_pair_that_ran_has_its_spread_at_each_step) {
  EngineTable table;
  const auto add = [&](auto&&... parts) { table.add(std::make_unique<FaultyEngine>(parts...)); };
  add("breaks", [](double&) { std::abort(); });
  add("creeps", [](double& x) { x += 0.25e-3; });
  add("stays", sit_still);
  const Results grid = run({drifting_body("a")}, table, {2, 60, {}, false});
  std::vector<Spread> spreads, own;
  for (const Spread& spread : grid.cases.front().spreads)
    (spread.first == spread.second ? own : spreads).push_back(spread);
  BOOST_TEST_REQUIRE(own.size() == 2u);  // each run at its coarse step, with itself at the fine one
  BOOST_TEST((own[0].dt.text == "1/10" && own[1].dt.text == "1/10"));
  BOOST_TEST(own[0].distance.value == 0.25e-3 * 5, boost::test_tools::tolerance(1e-12));  // 10 steps in place of 5
  BOOST_TEST(own[1].distance.value == 0);
  BOOST_TEST_REQUIRE(spreads.size() == 2u);  // one pair, two step sizes
  for (const Spread& spread : spreads) {
    BOOST_TEST(grid.runs[spread.first].text == "creeps");
    BOOST_TEST(grid.runs[spread.second].text == "stays");
    const int steps = spread.dt.text == "1/10" ? 5 : 10;
    BOOST_TEST(spread.distance.value == 0.25e-3 * steps, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(spread.compared_until == 0.5, boost::test_tools::tolerance(1e-12));
    // The fifth step is the first further than a millimetre.
    BOOST_TEST_REQUIRE(spread.parted_at.has_value());
    BOOST_TEST(*spread.parted_at == 5 * spread.dt.seconds, boost::test_tools::tolerance(1e-12));
  }
}

// However short the run is, a step has to hold for 30 s to be called stable.
BOOST_AUTO_TEST_CASE(a_step_that_blows_up_late_is_not_stable) {
  EngineTable table;
  table.add(std::make_unique<LateEngine>());
  const Results grid = run({drifting_body("a")}, table, {1, 60, {}, true});
  BOOST_TEST_REQUIRE(grid.cases.front().stable_steps.size() == 1u);
  const StableStepResult& found = grid.cases.front().stable_steps.front();
  BOOST_TEST((found.status == Status::pass), found.reason);
  BOOST_TEST(!found.step.is_cap);
  BOOST_TEST(found.step.dt <= 0.1);
  BOOST_TEST(found.step.dt > 0.099);  // to 1 % of the limit
  for (const Cell& cell : grid.cases.front().cells) BOOST_TEST((cell.status == Status::pass));
}

BOOST_AUTO_TEST_CASE(a_truth_that_does_not_fit_costs_one_case) {
  EngineTable table;
  table.add(std::make_unique<FaultyEngine>("good", sit_still));
  Case wrong = drifting_body("wrong");
  wrong.truth = "projectile", wrong.truth_where = "wrong.toml:9:1";
  wrong.scene.springs.push_back({kWorld, 0, Vec3::Zero(), Vec3(1, 0, 0), 10, 0, 1});
  Results grid = plan_grid({wrong, drifting_body("right")}, runs_of(table), table, {false});
  for (Cell& cell : grid.cases.front().cells)
    cell.status = Status::crashed, cell.reason = Cell().reason;  // springs and all
  run_grid(grid, table, {2, 60, {}, false}, [](std::size_t, std::size_t) {});
  BOOST_TEST(grid.cases[0].error_is_input);
  BOOST_TEST(grid.cases[0].error.starts_with("wrong.toml:9:1: "), grid.cases[0].error);
  for (const Cell& cell : grid.cases[0].cells) BOOST_TEST((cell.status == Status::invalid));
  for (const Cell& cell : grid.cases[1].cells) BOOST_TEST((cell.status == Status::pass));
}

BOOST_AUTO_TEST_CASE(what_an_engine_cannot_do_is_known_before_it_runs) {
  const EngineTable table = faulty_engines();
  Case definition = drifting_body("springy");
  definition.scene.springs.push_back({kWorld, 0, Vec3::Zero(), Vec3::Zero(), 10, 0, 1});
  const Results grid = plan_grid({definition}, runs_of(table), table, {true});
  for (const Cell& cell : grid.cases.front().cells) {
    BOOST_TEST((cell.status == Status::unsupported));
    BOOST_TEST(cell.reason.find("spring") != std::string::npos, cell.reason);
    BOOST_TEST(cell.trajectory.empty());
  }
}

BOOST_AUTO_TEST_CASE(a_cell_that_did_not_run_does_not_look_like_one_that_passed) {
  const EngineTable table = faulty_engines();
  const Results grid = plan_grid({drifting_body("a")}, runs_of(table), table, {true});
  for (const Cell& cell : grid.cases.front().cells) BOOST_TEST((cell.status != Status::pass));
}

BOOST_AUTO_TEST_CASE(an_empty_selection_is_an_error) {
  const EngineTable table = faulty_engines();
  BOOST_CHECK_THROW(plan_grid({}, runs_of(table), table, {true}), InputError);
  BOOST_CHECK_THROW(plan_grid({drifting_body("a")}, {}, table, {true}), InputError);
}

BOOST_AUTO_TEST_CASE(trajectories_have_names_of_their_own) {
  EngineTable table;
  table.add(std::make_unique<FaultyEngine>("good", sit_still));
  const std::vector<Case> alike = {drifting_body("a/b"),
                                   drifting_body("a-b"),
                                   drifting_body("a:b"),
                                   drifting_body("a?b"),
                                   drifting_body("/" + std::string(5000, 'x')),
                                   drifting_body("y" + std::string(5000, 'x'))};
  const Results grid = plan_grid(alike, runs_of(table), table, {true});
  std::set<std::string> names;
  for (const CaseResult& result : grid.cases) {
    for (const Cell& cell : result.cells) {
      BOOST_TEST(cell.trajectory.size() < 255u);
      BOOST_TEST(cell.trajectory.find('/') == std::string::npos);
      BOOST_TEST(names.insert(cell.trajectory).second, cell.trajectory);
    }
  }
}

BOOST_AUTO_TEST_CASE(only_cells_with_a_result_leave_a_trajectory) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("rigor_grid_test_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const EngineTable table = faulty_engines();
  const Results grid =
      run({drifting_body("a")}, table, {2, 0.5, {std::make_shared<TrajectoryRecorder>(folder.string())}, false});
  std::set<std::string> written, named;
  for (const auto& entry : fs::directory_iterator(folder)) written.insert(entry.path().filename().string());
  for (const Cell& cell : grid.cases.front().cells) {
    if (!cell.trajectory.empty()) named.insert(cell.trajectory);
  }
  fs::remove_all(folder);
  BOOST_TEST(written == named, boost::test_tools::per_element());
  BOOST_TEST(named.size() == 6u);  // good, warning and without numbers, at two step sizes each
}

BOOST_AUTO_TEST_CASE(steps_that_make_no_run_are_refused) {
  const auto refuses = [](const Overrides& overrides) {
    Case definition = drifting_body("a");
    BOOST_CHECK_THROW(override_run(definition, overrides), InputError);
  };
  refuses({{{0.6, "0.6"}}, {}});  // longer than the run of 0.5 s
  refuses({{{1e300, "1e300"}}, {}});
  refuses({{{1e-300, "1e-300"}}, {}});  // more steps than a count holds
  refuses({{}, 1e300});
  refuses({{}, 0.01});  // shorter than the case's own steps
  Case whole = drifting_body("a");
  override_run(whole, {{{0.5, "1/2"}}, {}});
  BOOST_TEST(whole.dt.size() == 1u);
}

BOOST_AUTO_TEST_CASE(the_default_runs_are_all_core_methods_and_each_other_engine_on_both_tracks) {
  const auto infos = infos_of(engines());
  std::set<std::string> names;
  for (const RunName& run : default_runs(infos)) names.insert(run.text);
  for (const std::string name :
       {"core:rk4", "core:explicit-euler", "core:semi-implicit-euler", "ode", "ode@stock", "bullet", "bullet@stock"}) {
    BOOST_TEST(names.contains(name), name);
  }
  BOOST_TEST(names.size() == default_runs(infos).size());
  for (const std::string& name : names) BOOST_TEST(name.find("twin") == std::string::npos, name);
}

BOOST_AUTO_TEST_CASE(any_executor_can_run_the_cases_and_is_told_each_as_data) {
  class Recording : public ProcessExecutor {
   public:
    Recording() : ProcessExecutor(1) {}
    void run(JobSource& jobs, const Work& work, const OnMessage& on_message, const OnEnd& on_end) const override {
      while (const auto job = jobs.next()) told.push_back(*job);
      ListedJobs again(told);
      ProcessExecutor::run(again, work, on_message, on_end);
    }
    mutable std::vector<JobSpec> told;
  };
  EngineTable table;
  table.add(std::make_unique<FaultyEngine>("good", sit_still));
  const Recording executor;
  GridOptions options{1, 60, {}, false};
  options.executor = &executor;
  const Results grid = run({drifting_body("a"), drifting_body("b")}, table, options);
  std::set<std::pair<std::size_t, std::size_t>> told;  // a case is told by its shares, each once
  for (const JobSpec& job : executor.told) {
    BOOST_TEST((job.kind == JobSpec::Kind::whole_case));
    BOOST_TEST(told.emplace(job.of_case, job.part).second);
  }
  for (const std::size_t of_case : {0u, 1u}) {
    BOOST_TEST(std::any_of(told.begin(), told.end(), [&](const auto& job) { return job.first == of_case; }));
  }
  for (const CaseResult& result : grid.cases) {
    for (const Cell& cell : result.cells) BOOST_TEST((cell.status == Status::pass));
  }
}

BOOST_AUTO_TEST_SUITE_END()
