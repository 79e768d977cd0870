// What a case's process does with its jobs: which it begins, what it calls their ends, and what it leaves for later.
#include "cases/runner/case_process.h"

#include <fmt/format.h>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "cases/case/run_selector.h"
#include "cases/runner/grid.h"
#include "cases/runner/journal/case_journal.h"
#include "core/engine/engine_failure.h"
#include "tests/cases/runner/faulty_engine.h"
#include "tests/folder.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_case_process)

namespace {

void spin() {
  volatile bool is_spinning = true;
  while (is_spinning) {
  }
}

// Does at each step what a test wants of the time and of the step.
class TimedEngine : public FaultyEngine {
 public:
  using Deed = std::function<void(double time, double dt, double& x)>;
  explicit TimedEngine(Deed deed, bool is_adaptive = false)
      : FaultyEngine("timed", [this](double& x) { deed_(time_, dt_, x); }),
        deed_(std::move(deed)),
        is_adaptive_(is_adaptive) {}
  EngineInfo info() const override {
    EngineInfo info = FaultyEngine::info();
    info.methods[0].adaptive = is_adaptive_, info.features = {joint_feature<BallJoint>()};
    return info;
  }
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override {
    return std::make_unique<TimedWorld>(*this, FaultyEngine::load(scene, settings));
  }

 private:
  class TimedWorld : public World {
   public:
    TimedWorld(const TimedEngine& engine, std::unique_ptr<World> world) : engine_(engine), world_(std::move(world)) {}
    void step(double dt) override {
      time_ += dt, engine_.time_ = time_, engine_.dt_ = dt;
      world_->step(dt);
    }
    void read(Snapshot& out) const override { world_->read(out); }
    SettingsInForce settings_in_force() const override { return {}; }
    std::string solver_warning() const override { return ""; }

   private:
    const TimedEngine& engine_;
    std::unique_ptr<World> world_;
    double time_ = 0;
  };

  Deed deed_;
  bool is_adaptive_;
  mutable double time_ = 0, dt_ = 0;  // s
};

// Recorders are called in the case's processes: what they were called for stands in a file.
class Noting : public Recorder {
 public:
  explicit Noting(std::string file) : file_(std::move(file)) {}
  std::string name() const override { return "noting"; }
  Recording of_truth(const Case&, const Truth&, const TruthFacts&) const override { return note("truth"); }
  Recording of_run(const Case&, const Cell& cell, const JudgedRun&, const std::vector<NamedSeries>& series,
                   const TruthFacts&) const override {
    return note(fmt::format("run {} {}", cell.dt.text, !series.empty()));
  }
  void discard(const Cell& cell) const override { note("discard " + cell.dt.text); }
  bool still_has(const Cell&) const override { return true; }
  std::map<std::string, int> noted() const {
    std::map<std::string, int> times;
    std::ifstream lines(file_);
    for (std::string line; std::getline(lines, line);) ++times[line];
    return times;
  }

 private:
  Recording note(const std::string& what) const {
    std::ofstream(file_, std::ios::app) << what + "\n";
    return {what};
  }
  std::string file_;
};

EngineTable one(std::unique_ptr<Engine> engine) {
  EngineTable table;
  table.add(std::move(engine));
  return table;
}

EngineTable timed(const TimedEngine::Deed& deed, bool is_adaptive = false) {
  return one(std::make_unique<TimedEngine>(deed, is_adaptive));
}

CaseResult run(const Case& definition, const EngineTable& table, const GridOptions& options) {
  const auto infos = infos_of(table);
  Results grid = plan_grid({definition}, {parse_run_name(infos[0].name, infos)}, table, {options.stable_steps});
  run_grid(grid, table, options, [](std::size_t, std::size_t) {});
  return grid.cases.front();
}

GridOptions quick(bool with_stable_steps, double limit = 20) {
  GridOptions options;
  options.limit = limit, options.stable_steps = with_stable_steps, options.is_thorough = false;
  return options;
}

}  // namespace

// However short the run is; but where it is longer, as long as the run.
BOOST_AUTO_TEST_CASE(a_step_has_to_hold_for_thirty_seconds_or_the_run) {
  const auto lost_after = [](double end) {
    return timed([end](double time, double, double& x) { x = time > end ? std::nan("") : 0; });
  };
  Case definition = drifting_body("a");
  BOOST_TEST(run(definition, lost_after(31), quick(true)).stable_steps[0].step.is_cap);
  BOOST_TEST(run(definition, lost_after(29), quick(true)).stable_steps[0].step.is_floor);
  definition.duration = 40;
  BOOST_TEST(run(definition, lost_after(31), quick(true)).stable_steps[0].step.is_floor);
}

// In jointed scenes an adaptive method is searched only over the run's own duration.
BOOST_AUTO_TEST_CASE(an_adaptive_method_among_joints_has_to_hold_for_the_run) {
  Case definition = drifting_body("a");
  definition.scene.bodies[0].velocity = Vec3::Zero();
  const auto lost = [](double time, double, double& x) { x = time > 3 ? std::nan("") : 0; };
  for (const bool is_jointed : {true, false}) {
    if (is_jointed) definition.scene.joints = {{.a = kWorld, .b = 0, .type = BallJoint{Vec3::Zero()}}};
    if (!is_jointed) definition.scene.joints.clear();
    for (const bool is_adaptive : {true, false}) {
      const StableStepResult found = run(definition, timed(lost, is_adaptive), quick(true)).stable_steps[0];
      BOOST_TEST((found.status == Status::pass), found.reason);
      BOOST_TEST(found.step.is_cap == (is_jointed && is_adaptive));
      BOOST_TEST(found.reason == found.step.cut);
    }
  }
}

// Whichever step comes first in the case: a coarser one is tried, and no search begun where it has no result either.
BOOST_AUTO_TEST_CASE(a_step_is_given_up_by_what_coarser_ones_took) {
  const std::string out_of_time = "no result within the limit of 0.1 s";
  Case definition = drifting_body("a");
  std::swap(definition.dt[0], definition.dt[1]);
  const CaseResult both = run(definition, timed([](double, double, double&) { spin(); }), quick(true, 0.1));
  for (const Cell& cell : both.cells) {
    BOOST_TEST((cell.status == Status::timed_out));
    BOOST_TEST(cell.reason == out_of_time);
    BOOST_TEST(cell.wall_seconds >= 0.1);
    BOOST_TEST(cell.trajectory == "");
  }
  BOOST_TEST((both.stable_steps[0].status == Status::timed_out));
  BOOST_TEST(both.stable_steps[0].reason == "not tried: at 1/10 s there was " + out_of_time);
  // At 1/20 s alone: coarser steps, which the search begins with, have their results.
  const auto fine = [](double, double dt, double&) {
    if (dt < 0.08) spin();
  };
  const CaseResult finer = run(definition, timed(fine), quick(true, 0.1));
  BOOST_TEST((finer.cells[0].status == Status::timed_out));
  BOOST_TEST((finer.cells[1].status == Status::pass), finer.cells[1].reason);
  BOOST_TEST((finer.stable_steps[0].status == Status::pass), finer.stable_steps[0].reason);
  BOOST_TEST(finer.stable_steps[0].step.is_cap);
}

BOOST_AUTO_TEST_CASE(each_kind_of_failure_has_its_status) {
  for (const auto& [kind, status] : {std::pair{FailureKind::unsupported, Status::unsupported},
                                     {FailureKind::diverged, Status::diverged},
                                     {FailureKind::crashed, Status::crashed},
                                     {FailureKind::timed_out, Status::timed_out},
                                     {FailureKind::invalid, Status::invalid}}) {
    const auto fails = [kind](double, double, double&) { throw EngineFailure(kind, "so it says"); };
    const CaseResult result = run(drifting_body("a"), timed(fails), quick(true));
    for (const Cell& cell : result.cells) {
      BOOST_TEST((cell.status == status), word_of(cell.status));
      BOOST_TEST(cell.reason == "so it says");
      BOOST_TEST(cell.trajectory == "");
    }
    BOOST_TEST((result.stable_steps[0].status == status));
    BOOST_TEST(result.stable_steps[0].reason == "so it says");
    BOOST_TEST(result.error == "");
  }
}

// Finished cells are not repeated: the second engine would crash.
BOOST_AUTO_TEST_CASE(a_journal_keeps_the_truth_and_each_answer_but_no_time_out) {
  const Folder folder;
  Case definition = drifting_body("a");
  definition.truth = "reference";
  GridOptions options = quick(true);
  options.journals = folder.path.string();
  const auto table_of = [](const TimedEngine::Deed& deed) { return timed(deed); };
  const EngineTable good = table_of([](double, double, double&) {}),
                    crashing = table_of([](double, double, double&) { std::abort(); });
  const CaseResult first = run(definition, good, options);
  const auto infos = infos_of(good);
  const Results plan = plan_grid({definition}, {parse_run_name("timed", infos)}, good, {true});
  const std::string file = journal_of(plan.cases[0], plan, 0, options);
  {
    const Journal journal(file, plan_of(plan, plan.cases[0], good, options));
    BOOST_TEST_REQUIRE(journal.found().size() == 4u);
    for (const std::size_t job : {std::size_t{0}, std::size_t{1}, std::size_t{2}, Journal::kTruth})
      BOOST_TEST(journal.found().contains(job));
  }
  const CaseResult again = run(definition, crashing, options);
  for (const CaseResult* result : {&first, &again}) {
    BOOST_TEST(result->error == "");
    BOOST_TEST(result->truth.has_value());
    for (const Cell& cell : result->cells) BOOST_TEST((cell.status == Status::pass), cell.reason);
    BOOST_TEST((result->stable_steps[0].status == Status::pass));
  }
  BOOST_TEST(again.truth->largest_kinetic_energy == first.truth->largest_kinetic_energy);
  // One that was out of time has another try, and what was done beside it has not.
  std::filesystem::remove(file);
  options.limit = 1;
  const CaseResult late = run(definition, table_of([](double, double dt, double&) {
                                if (dt == 0.05) spin();
                              }),
                              options);
  BOOST_TEST((late.cells[0].status == Status::pass && late.cells[1].status == Status::timed_out));
  options.limit = 20;
  const CaseResult later = run(definition, table_of([](double, double dt, double&) {
                                 if (dt != 0.05) std::abort();
                               }),
                               options);
  for (const Cell& cell : later.cells) BOOST_TEST((cell.status == Status::pass), cell.reason);
  BOOST_TEST((later.stable_steps[0].status == Status::pass), later.stable_steps[0].reason);
}

// Lifted by 1 km against 10 m/s² it has 10 kJ. This is a thousand times the truth's energy in half a second, and less
// than ten times the 45 kJ in thirty seconds. A thousand km exceed both. The case's own cells stay as they are, because
// a largest step lies below every step at which one of them fails.
BOOST_AUTO_TEST_CASE(what_a_stable_step_may_gain_is_measured_by_the_truth_over_thirty_seconds) {
  Case definition = drifting_body("a");
  definition.truth = "reference", definition.scene.gravity = {-10, 0, 0};
  for (const auto& [height, is_cap] : {std::pair{1e3, true}, {1e6, false}}) {
    const auto lifted = [height, own = definition.dt](double, double dt, double& x) {
      const auto is_own = [dt](const StepSize& step) { return step.seconds == dt; };
      if (std::none_of(own.begin(), own.end(), is_own)) x = height;
    };
    BOOST_TEST(run(definition, timed(lifted), quick(true)).stable_steps[0].step.is_cap == is_cap, height);
  }
}

BOOST_AUTO_TEST_CASE(a_case_that_asks_for_ensembles_has_them) {
  Case definition = drifting_body("a");
  definition.ensemble = 8;
  const auto reason_of = [&](const GridOptions& options) {
    const auto infos = infos_of(engines());
    Results grid = plan_grid({definition}, {parse_run_name("core:velocity-verlet", infos)}, engines(), {false});
    run_grid(grid, engines(), options, [](std::size_t, std::size_t) {});
    return grid.cases[0].cells[0].metrics.at("ensemble_p_value").not_applicable;
  };
  GridOptions options = quick(false);
  BOOST_TEST(reason_of(options) == "");
  options.only_metrics = {"ensemble_p_value"};
  BOOST_TEST(reason_of(options) == "");
  options.only_metrics.clear(), definition.ensemble = 0;
  BOOST_TEST(reason_of(options) == "the case asks for no ensemble");
}

BOOST_AUTO_TEST_CASE(recorders_are_called_once_for_the_truth_and_for_each_end) {
  const Folder folder;
  const auto noting = std::make_shared<Noting>((folder.path / "noted").string());
  Case definition = drifting_body("a");
  definition.truth = "reference";
  GridOptions options = quick(false);
  options.recorders = {noting}, options.journals = folder.path.string();
  const auto fails_finer = [](double, double dt, double&) {
    if (dt < 0.08) throw EngineFailure(FailureKind::crashed, "it fell over");
  };
  // What an earlier run left is discarded before each cell, and what a failed cell left after it.
  const std::map<std::string, int> expected = {
      {"truth", 1}, {"run 1/10 true", 1}, {"discard 1/10", 1}, {"discard 1/20", 2}};
  for (int time = 0; time < 2; ++time) {  // the second time all of it is known
    const CaseResult result = run(definition, timed(fails_finer), options);
    BOOST_TEST((noting->noted() == expected), time);
    BOOST_TEST((result.truth.value().recordings == Recordings{{"noting", {"truth"}}}));
    BOOST_TEST((result.cells[0].recordings == Recordings{{"noting", {"run 1/10 true"}}}));
    BOOST_TEST(result.cells[0].wall_seconds > 0);
    BOOST_TEST(result.cells[1].reason == "it fell over");
  }
}

BOOST_AUTO_TEST_SUITE_END()
