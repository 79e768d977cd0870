// What a grid makes of its jobs' messages and ends: an executor that runs nothing and says what a test wants.
#include <boost/test/unit_test.hpp>

#include "cases/results/result_json.h"
#include "cases/results/spread.h"
#include "cases/runner/grid.h"
#include "cases/runner/journal/case_journal.h"
#include "cases/runner/shards/shard.h"
#include "tests/cases/runner/faulty_engine.h"
#include "tests/folder.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_grid_jobs)

namespace {

class SayingExecutor : public Executor {
 public:
  using Say = std::function<void(const JobSpec& job, const std::function<void(const std::string&)>& say,
                                 const std::function<void(const JobEnd&)>& end)>;
  explicit SayingExecutor(Say say) : say_(std::move(say)) {}
  void begin(const std::string& plan, const std::string& folder) const override { begun = {plan, folder}; }
  void run(JobSource& jobs, const Work&, const OnMessage& on_message, const OnEnd& on_end) const override {
    std::size_t number = 0;
    while (const auto job = jobs.next()) {
      told.push_back(*job);
      say_(
          *job, [&](const std::string& message) { on_message(number, message); },
          [&](const JobEnd& end) { on_end(number, end); });
      ++number;
    }
  }
  mutable std::vector<JobSpec> told;
  mutable std::pair<std::string, std::string> begun;

 private:
  Say say_;
};

void say_nothing(const JobSpec&, const std::function<void(const std::string&)>&,
                 const std::function<void(const JobEnd&)>&) {}

EngineTable two_engines() {
  EngineTable table;
  for (const char* name : {"one", "other"}) table.add(std::make_unique<FaultyEngine>(name, [](double&) {}));
  return table;
}

Results planned(const std::vector<Case>& cases) {
  const EngineTable table = two_engines();
  const auto infos = infos_of(table);
  return plan_grid(cases, {parse_run_name("one", infos), parse_run_name("other", infos)}, table, {true});
}

struct Ran {
  Results grid;
  std::vector<std::pair<std::size_t, std::size_t>> progress;  // done, of all
};

Ran run_with(const SayingExecutor& executor, const Results& plan, const std::string& journals = "") {
  Ran ran{plan, {}};
  GridOptions options;
  options.executor = &executor, options.journals = journals, options.limit = 7;
  run_grid(ran.grid, two_engines(), options,
           [&](std::size_t done, std::size_t all) { ran.progress.emplace_back(done, all); });
  return ran;
}

std::string passing(const Results& grid, std::size_t of, std::size_t cell) {
  Cell done = grid.cases[of].cells[cell];
  done.status = Status::pass, done.reason.clear();
  return message_of_cell(cell, done, grid.cases[of].definition.scene);
}

std::string stable(std::size_t run) {
  return message_of_stable_step(run, {Status::pass, "", {0.125, false, false, ""}});
}

JobEnd ended(Ending how, const std::string& text = "") {
  JobEnd end;
  end.how = how, end.text = text, end.code = 3;
  return end;
}

}  // namespace

// Steps times bodies: 15, 15 of twice as many bodies, 30, and 3 that are left of 150 where one of two steps is not
// supported.
BOOST_AUTO_TEST_CASE(the_case_with_most_to_do_is_first_and_all_agree_on_the_plan) {
  std::vector<Case> cases;
  for (const char* id : {"a", "b", "c", "d"}) cases.push_back(drifting_body(id));
  cases[1].scene.bodies.push_back(cases[1].scene.bodies[0]), cases[1].scene.bodies[1].name = "another";
  cases[2].duration = 1;
  cases[3].dt[1] = {0.001, "1/1000"};
  Results plan = planned(cases);
  for (const std::size_t cell : {1u, 3u}) plan.cases[3].cells[cell].status = Status::unsupported;
  const SayingExecutor executor(say_nothing);
  const Ran ran = run_with(executor, plan, "a folder");
  std::vector<std::size_t> order;
  for (const JobSpec& job : executor.told) {
    if (order.empty() || order.back() != job.of_case) order.push_back(job.of_case);
    BOOST_TEST((job.kind == JobSpec::Kind::whole_case && job.limit == 7));
  }
  BOOST_TEST((order == std::vector<std::size_t>{1, 2, 0, 3}));
  BOOST_TEST(executor.begun.second == "a folder");
  const EngineTable table = two_engines();
  GridOptions options;
  options.executor = &executor;
  std::string all;
  for (const CaseResult& planned : plan.cases) all += plan_of(plan, planned, table, options);
  BOOST_TEST((executor.begun.first == all));
  BOOST_TEST(ran.grid.wall_seconds > 0);
}

BOOST_AUTO_TEST_CASE(progress_is_counted_by_cells_and_stable_steps_and_by_nothing_else) {
  Results plan = planned({drifting_body("a")});
  plan.cases[0].cells[3].status = Status::unsupported, plan.cases[0].stable_steps[1].status = Status::unsupported;
  bool is_first = true;
  const SayingExecutor executor([&](const JobSpec&, const auto& say, const auto&) {
    if (!std::exchange(is_first, false)) return;
    say(message_of_truth({1e-12, 7, 2, 3}));
    say(passing(plan, 0, 1)), say(stable(0)), say(message_of_spreads({})), say(passing(plan, 0, 0));
  });
  const Ran ran = run_with(executor, plan);
  BOOST_TEST((ran.progress == std::vector<std::pair<std::size_t, std::size_t>>{{1, 4}, {2, 4}, {3, 4}}));
  BOOST_TEST(ran.grid.cases[0].truth.value().horizon == 7);
  BOOST_TEST((ran.grid.cases[0].cells[1].status == Status::pass));
  BOOST_TEST(ran.grid.cases[0].stable_steps[0].step.dt == 0.125);
  BOOST_TEST(ran.grid.cases[0].error == "");
}

// Each process is told of what it was to do alone: a cell, another, and a search.
BOOST_AUTO_TEST_CASE(how_a_cases_process_ended_is_said_of_all_that_was_not_heard_of) {
  struct Row {
    JobEnd end;
    bool has_truth, is_garbled;
    std::string error;
    Status status;
  };
  const std::string broke = "the process of this case broke off: ", none = "the truth of this case was not found: ";
  for (const Row& row :
       {Row{ended(Ending::refused, "no such truth"), false, false, "a.toml:9:1: no such truth", Status::invalid},
        {ended(Ending::timed_out), true, false, broke + "no result within the limit of 7 s", Status::timed_out},
        {ended(Ending::timed_out), false, false, none + "no result within the limit of 7 s", Status::timed_out},
        {ended(Ending::exited), true, false, broke + "called exit(3) before it had answered", Status::crashed},
        {ended(Ending::finished), true, true, "a message of this case's process could not be read: ", Status::crashed},
        {ended(Ending::finished), true, false, "", Status::crashed}}) {
    Case definition = drifting_body("a");
    definition.truth_where = "a.toml:9:1";
    Results plan = planned({definition});
    // One cell is left to do for each process: the others are nobody's.
    for (const std::size_t cell : {2u, 3u}) plan.cases[0].cells[cell].status = Status::unsupported;
    plan.cases[0].cells[3].reason = "cannot";
    plan.cases[0].stable_steps[0].status = Status::unsupported;
    const SayingExecutor executor([&](const JobSpec& job, const auto& say, const auto& end) {
      if (row.has_truth) say(message_of_truth({1e-12, 7, 2, 3}));
      const int first = shares_in(Partition(plan, kShares).cases()[0]).front();
      if (static_cast<int>(job.part) == first) say(passing(plan, 0, 0));
      if (row.is_garbled) say("{\"cell\":0, and so on");
      end(row.end);
    });
    const CaseResult result = run_with(executor, plan).grid.cases[0];
    BOOST_TEST_CONTEXT(row.error) {
      BOOST_TEST(result.error.starts_with(row.error), result.error);
      BOOST_TEST(result.error.empty() == row.error.empty());
      BOOST_TEST(result.error_is_input == (row.end.how == Ending::refused));
      BOOST_TEST((result.cells[0].status == Status::pass));
      BOOST_TEST((result.cells[1].status == row.status), word_of(result.cells[1].status));
      BOOST_TEST(result.cells[1].reason == (row.error.empty() ? "it did not run" : result.error));
      BOOST_TEST(result.cells[1].trajectory.empty() == !row.error.empty());
      BOOST_TEST((result.cells[3].status == Status::unsupported && result.cells[3].reason == "cannot"));
      BOOST_TEST((result.stable_steps[1].status == row.status));
      BOOST_TEST(result.stable_steps[1].reason == (row.error.empty() ? "it did not run" : result.error));
      BOOST_TEST((result.stable_steps[0].status == Status::unsupported));
    }
  }
}

// Cells of different processes have left their paths in the journals of their shares.
BOOST_AUTO_TEST_CASE(pairs_of_cells_that_different_processes_did_have_their_spread) {
  const Folder folder;
  const Results plan = planned({drifting_body("a")});
  const EngineTable table = two_engines();
  const ProcessExecutor any(1);
  GridOptions options;
  options.journals = folder.path.string(), options.executor = &any;
  const Partition::OfCase shares = Partition(plan, kShares).cases()[0];
  const SayingExecutor executor([&](const JobSpec& job, const auto&, const auto&) {
    CaseResult own = plan.cases[0];
    leave_to_others(own, shares, static_cast<int>(job.part));
    Journal journal(journal_of(plan.cases[0], plan, static_cast<int>(job.part), options),
                    plan_of(plan, own, table, options));
    for (std::size_t cell = 0; cell < own.cells.size(); ++cell) {
      if (own.cells[cell].status == Status::unsupported) continue;
      Path path;
      path.bodies = 1;
      for (const double t : {0.0, 0.5})
        path.times.push_back(t), path.poses.push_back({0.25 * static_cast<double>(cell), 0, 0, 1, 0, 0, 0});
      journal.add(cell, {passing(plan, 0, cell), packed(path)});
    }
  });
  const Ran ran = run_with(executor, plan, options.journals);
  BOOST_TEST(executor.told.size() > 1u);
  auto spreads = ran.grid.cases[0].spreads;
  std::erase_if(spreads, [](const Spread& spread) { return spread.first == spread.second; });
  BOOST_TEST_REQUIRE(spreads.size() == 2u);  // at each of two steps one pair of runs, two cells apart
  for (const Spread& spread : spreads) {
    BOOST_TEST(spread.distance.value == 0.5);
    BOOST_TEST((spread.first == 0 && spread.second == 1));
  }
  BOOST_TEST(spreads[0].dt.text == "1/10");
  BOOST_TEST(spreads[1].dt.text == "1/20");
}

// Two of them are enough.
BOOST_AUTO_TEST_CASE(a_case_that_two_processes_did_has_its_spread) {
  const Folder folder;
  Results plan = planned({drifting_body("a")});
  for (const std::size_t cell : {1u, 3u}) plan.cases[0].cells[cell].status = Status::unsupported;
  for (StableStepResult& step : plan.cases[0].stable_steps) step.status = Status::unsupported;
  const EngineTable table = two_engines();
  const ProcessExecutor any(1);
  GridOptions options;
  options.journals = folder.path.string(), options.executor = &any;
  const Partition::OfCase shares = Partition(plan, kShares).cases()[0];
  const SayingExecutor executor([&](const JobSpec& job, const auto&, const auto&) {
    CaseResult own = plan.cases[0];
    leave_to_others(own, shares, static_cast<int>(job.part));
    const std::size_t cell = own.cells[0].status == Status::unsupported ? 2 : 0;
    Journal journal(journal_of(plan.cases[0], plan, static_cast<int>(job.part), options),
                    plan_of(plan, own, table, options));
    Path path;
    path.bodies = 1, path.times = {0}, path.poses = {{0.25 * static_cast<double>(cell), 0, 0, 1, 0, 0, 0}};
    journal.add(0, {passing(plan, 0, cell), packed(path)});
  });
  const Ran ran = run_with(executor, plan, options.journals);
  BOOST_TEST(executor.told.size() == 2u);
  BOOST_TEST(ran.grid.cases[0].spreads.size() == 1u);
}

// One process that did all of a case has said its spreads itself.
BOOST_AUTO_TEST_CASE(a_case_of_one_share_keeps_the_spreads_that_its_process_said) {
  Results plan = planned({drifting_body("a")});
  for (std::size_t cell = 1; cell < 4; ++cell) plan.cases[0].cells[cell].status = Status::unsupported;
  for (StableStepResult& step : plan.cases[0].stable_steps) step.status = Status::unsupported;
  Spread said;
  said.first = 0, said.second = 1, said.dt = plan.cases[0].cells[0].dt;
  const SayingExecutor executor([&](const JobSpec&, const auto& say, const auto&) { say(message_of_spreads({said})); });
  const Ran ran = run_with(executor, plan);
  BOOST_TEST(executor.told.size() == 1u);
  BOOST_TEST(ran.grid.cases[0].spreads.size() == 1u);
}

BOOST_AUTO_TEST_SUITE_END()
