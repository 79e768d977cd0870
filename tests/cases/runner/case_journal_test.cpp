// What a case's journal depends on, what of it is believed, and what executors' shares of it hold.
#include "cases/runner/journal/case_journal.h"

#include <boost/test/unit_test.hpp>

#include "cases/results/result_json.h"
#include "cases/runner/shards/shard.h"
#include "tests/cases/runner/faulty_engine.h"
#include "tests/folder.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_case_journal)

namespace {

// An engine of this program, and one from outside.
EngineTable engines_inside_and_outside(const std::string& identity = "its hash") {
  EngineTable table;
  table.add(std::make_unique<FaultyEngine>("inside", [](double&) {}));
  table.add(std::make_unique<FaultyEngine>("outside", [](double&) {}), identity);
  return table;
}

Results planned(const EngineTable& table, const std::vector<Case>& cases = {drifting_body("a"), drifting_body("b")}) {
  const auto infos = infos_of(table);
  return plan_grid(cases, {parse_run_name("inside", infos), parse_run_name("outside", infos)}, table, {true});
}

// Has kept the trajectory of cells at 1/10 s alone.
class HalfKept : public Recorder {
 public:
  std::string name() const override { return "half"; }
  Recording of_truth(const Case&, const Truth&, const TruthFacts&) const override { return {}; }
  Recording of_run(const Case&, const Cell&, const JudgedRun&, const std::vector<NamedSeries>&,
                   const TruthFacts&) const override {
    return {};
  }
  void discard(const Cell&) const override {}
  bool still_has(const Cell& cell) const override { return cell.dt.text == "1/10"; }
};

// Of a cell that ended so.
Journal::Record ended(const Results& grid, std::size_t cell, Status status) {
  Cell done = grid.cases[0].cells[cell];
  done.status = status, done.reason = status == Status::pass ? "" : "it fell over";
  return {message_of_cell(cell, done, grid.cases[0].definition.scene), ""};
}

Journal::Record stable(std::size_t run) {
  return {message_of_stable_step(run, {Status::crashed, "it fell over", {}}), ""};
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_share_of_each_case_has_a_file_of_its_own) {
  const EngineTable table = engines_inside_and_outside();
  const Results grid = planned(table);
  GridOptions options;
  BOOST_TEST(journal_of(grid.cases[1], grid, 0, options) == "");
  options.journals = "folder";
  BOOST_TEST(journal_of(grid.cases[0], grid, 0, options) == "folder/0.journal");
  BOOST_TEST(journal_of(grid.cases[1], grid, 0, options) == "folder/1.journal");
  BOOST_TEST(journal_of(grid.cases[1], grid, 1, options) == "folder/1.1.journal");
  BOOST_TEST(journal_of(grid.cases[1], grid, 7, options) == "folder/1.7.journal");
}

// Everything that may change the results gives another plan.
BOOST_AUTO_TEST_CASE(a_plan_is_of_all_that_its_case_depends_on) {
  const EngineTable table = engines_inside_and_outside(), other = engines_inside_and_outside("another hash");
  const Results grid = planned(table);
  const GridOptions options;
  const std::string plan = plan_of(grid, grid.cases[0], table, options);
  BOOST_TEST(plan == plan_of(grid, grid.cases[0], table, options));
  BOOST_TEST(plan != plan_of(grid, grid.cases[1], table, options));
  BOOST_TEST(plan != plan_of(grid, grid.cases[0], other, options));
  const auto changes = [&](const std::string& what, const std::function<void(Results&)>& change) {
    Results changed = grid;
    change(changed);
    BOOST_TEST(plan != plan_of(changed, changed.cases[0], table, options), what);
  };
  changes("duration", [](Results& r) { r.cases[0].definition.duration = 0.6; });
  changes("text", [](Results& r) { r.cases[0].definition.text = "another"; });
  changes("cases", [](Results& r) { r.cases.pop_back(); });
  changes("runs", [](Results& r) { r.runs[1].text += ",option=on"; });
  changes("gates", [](Results& r) { r.cases[0].definition.gates.emplace_back().metric = "cost"; });
  changes("steps", [](Results& r) { r.cases[0].cells[1].dt.seconds = 0.06; });
  changes("status", [](Results& r) { r.cases[0].cells[1].status = Status::unsupported; });
  changes("trajectory", [](Results& r) { r.cases[0].cells[1].trajectory = "another.csv"; });
  changes("search", [](Results& r) { r.cases[0].stable_steps[1].status = Status::unsupported; });
  const auto asks = [&](const std::string& what, const std::function<void(GridOptions&)>& change) {
    GridOptions changed = options;
    change(changed);
    BOOST_TEST(plan != plan_of(grid, grid.cases[0], table, changed), what);
  };
  asks("recorders", [](GridOptions& o) { o.recorders = {std::make_shared<HalfKept>()}; });
  asks("stable steps", [](GridOptions& o) { o.stable_steps = false; });
  asks("thorough", [](GridOptions& o) { o.is_thorough = false; });
}

BOOST_AUTO_TEST_CASE(what_is_wrong_or_may_end_otherwise_is_not_believed) {
  const Folder folder;
  const EngineTable table = engines_inside_and_outside();
  const Results grid = planned(table);
  const auto believed = [&](const Journal::Record& record, const GridOptions& options) {
    const std::string file = (folder.path / "j").string();
    std::filesystem::remove(file);
    Journal(file, "plan").add(0, record);
    Journal again(file, "plan");
    BOOST_TEST_REQUIRE(again.found().size() == 1u);
    forget_what_is_wrong(again, grid, grid.cases[0], table, options);
    return !again.found().empty();
  };
  // Sorted by engine, then by step.
  const std::size_t inside = 0, inside_finer = 1, outside = 2;
  for (const Status status : {Status::pass, Status::crashed, Status::timed_out, Status::diverged, Status::invalid}) {
    const bool came_to_nothing = status == Status::crashed || status == Status::timed_out;
    BOOST_TEST(believed(ended(grid, inside, status), {}));
    BOOST_TEST(believed(ended(grid, outside, status), {}) == !came_to_nothing, word_of(status));
  }
  BOOST_TEST(believed(stable(1), {}));
  BOOST_TEST(!believed({"{\"cell\":0, and so on", ""}, {}));
  BOOST_TEST(!believed({message_of_stable_step(9, {}), ""}, {}));
  GridOptions kept;
  kept.recorders = {std::make_shared<HalfKept>()};
  BOOST_TEST(believed(ended(grid, inside, Status::pass), kept));
  BOOST_TEST(!believed(ended(grid, inside_finer, Status::pass), kept));
  BOOST_TEST(believed(stable(1), kept));
}

BOOST_AUTO_TEST_CASE(the_answers_of_a_case_are_those_of_all_its_shares_but_not_its_truth) {
  const Folder folder;
  const EngineTable table = engines_inside_and_outside();
  // Steps so fine that each cell is a share of its own.
  std::vector<Case> cases = {drifting_body("a"), drifting_body("b")};
  for (Case& definition : cases) definition.dt = {{1e-5, "1e-5"}, {0.5e-5, "0.5e-5"}};
  const Results grid = planned(table, cases);
  GridOptions options;
  options.journals = folder.path.string();
  const ProcessExecutor executor(1);
  options.executor = &executor;
  const Partition::OfCase shares = Partition(grid, kShares).cases()[1];
  BOOST_TEST(shares_in(shares).size() > 2u);
  for (const int share : shares_in(shares)) {
    CaseResult own = grid.cases[1];
    leave_to_others(own, shares, share);
    Journal journal(journal_of(grid.cases[1], grid, share, options), plan_of(grid, own, table, options));
    journal.add(Journal::kTruth, {"the truth", ""});
    journal.add(0, {std::to_string(share), ""});
  }
  const auto answers = kept_answers(grid, grid.cases[1], table, options);
  BOOST_TEST_REQUIRE(answers.size() == shares_in(shares).size());
  for (std::size_t k = 0; k < answers.size(); ++k)
    BOOST_TEST(answers[k].message == std::to_string(shares_in(shares)[k]));
  BOOST_TEST(kept_answers(grid, grid.cases[0], table, options).empty());
  // Processes of this machine keep one journal a case.
  options.executor = nullptr;
  {
    Journal journal(journal_of(grid.cases[1], grid, 0, options), plan_of(grid, grid.cases[1], table, options));
    journal.add(0, {"of all", ""});
  }
  const auto whole = kept_answers(grid, grid.cases[1], table, options);
  BOOST_TEST_REQUIRE(whole.size() == 1u);
  BOOST_TEST(whole[0].message == "of all");
}

// Found by its cell, at any place.
BOOST_AUTO_TEST_CASE(paths_are_of_the_cells_that_left_one) {
  const EngineTable table = engines_inside_and_outside();
  const Results grid = planned(table);
  Path path;
  path.bodies = 1, path.times = {0}, path.poses = {{1, 2, 3, 1, 0, 0, 0}};
  Journal::Record with_path = ended(grid, 2, Status::pass);
  with_path.path = packed(path);
  const PathsOfCells paths = paths_in(grid.cases[0], {ended(grid, 1, Status::pass), with_path, stable(0)});
  BOOST_TEST_REQUIRE(paths.size() == 1u);
  BOOST_TEST(paths.at(2).poses.at(0)[1] == 2);
}

BOOST_AUTO_TEST_SUITE_END()
