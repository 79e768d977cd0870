// Parts of a grid: a partition that leaves nothing out and does nothing twice, and their merge at scale.
#include "cases/runner/shards/shard.h"

#include <fmt/format.h>
#include <boost/test/unit_test.hpp>
#include <chrono>

#include "cases/report/json/json_report.h"
#include "cases/report/reports.h"
#include "cases/runner/shards/part.h"
#include "core/base/error.h"
#include "tests/cases/runner/faulty_engine.h"
#include "tests/folder.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_shard)

namespace {

// Some cells of `count` cases are as long as a thousand others.
std::vector<Case> cases_of(int count) {
  std::vector<Case> cases;
  for (int i = 0; i < count; ++i) {
    cases.push_back(drifting_body(fmt::format("case-{}", i)));
    cases.back().dt.clear();
    for (const int n : {10, 20, 30, 40, 10000}) cases.back().dt.push_back({1.0 / n, fmt::format("1/{}", n)});
  }
  return cases;
}

EngineTable one_engine() {
  EngineTable table;
  table.add(std::make_unique<FaultyEngine>("good", [](double&) {}));
  return table;
}

Results planned(int count, bool with_stable_steps) {
  const EngineTable table = one_engine();
  return plan_grid(cases_of(count), {parse_run_name("good", table.infos())}, table, {with_stable_steps});
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_shard_is_two_whole_numbers_of_which_the_first_is_at_most_the_second) {
  BOOST_TEST((parse_shard("1/1", "--shard") == Shard{1, 1}));
  BOOST_TEST((parse_shard("2/8", "--shard") == Shard{2, 8}));
  BOOST_TEST((parse_shard("100000/100000", "--shard") == Shard{100000, 100000}));
  for (const char* text : {"", "1", "/", "/2", "1/", "0/1", "-1/2", "5/4", "1/0", "1/100001", "a/2", "1/b", "1/2x",
                           "1x/2", " 1/2", "1 /2", "1/2/3", "99999999999/99999999999"})
    BOOST_CHECK_THROW(parse_shard(text, "--shard"), InputError);
}

BOOST_AUTO_TEST_CASE(a_case_is_of_the_shards_of_its_truth_its_searches_and_its_cells) {
  const Partition::OfCase of_case{1, {2, 3, 0}, {4, 5, 0}}, of_nobody{3, {0}, {0, 0}};
  for (const int shard : {1, 2, 3, 4, 5}) BOOST_TEST(of_case.has(shard));
  BOOST_TEST(!of_case.has(6));
  BOOST_TEST((shares_in(of_case) == std::vector<int>{2, 3, 4, 5}));
  BOOST_TEST((shares_in(of_nobody) == std::vector<int>{3}));
}

BOOST_AUTO_TEST_CASE(every_job_is_in_exactly_one_share) {
  const Results grid = planned(7, true);
  for (const int count : {1, 2, 3, 8, 50, 1000}) {
    std::map<std::string, int> cells, steps;
    for (int k = 1; k <= count; ++k) {
      for (const CaseResult& result : share_of(grid, {k, count}).cases) {
        for (std::size_t i = 0; i < result.cells.size(); ++i) {
          const Cell& cell = result.cells[i];
          BOOST_TEST((cell.status == Status::crashed || cell.skipped == SkipReason::another_shard));
          cells[fmt::format("{} {}", result.definition.id, i)] += cell.status == Status::crashed;
        }
        for (const StableStepResult& stable : result.stable_steps)
          steps[result.definition.id] += stable.status == Status::crashed;
      }
    }
    BOOST_TEST(cells.size() == 35u);
    BOOST_TEST(steps.size() == 7u);
    for (const auto& [name, times] : cells) BOOST_TEST(times == 1, count << " shards: " << name);
    for (const auto& [name, times] : steps) BOOST_TEST(times == 1, count << " shards: " << name);
  }
}

// A scene that no engine supports has no job. Its truth, which reports show, still belongs to one shard.
BOOST_AUTO_TEST_CASE(a_case_that_nobody_runs_is_of_one_shard) {
  Results grid = planned(3, false);
  for (Cell& cell : grid.cases[1].cells) cell.status = Status::unsupported;
  int shares = 0;
  for (int k = 1; k <= 4; ++k) {
    for (const CaseResult& result : share_of(grid, {k, 4}).cases) shares += result.definition.id == "case-1";
  }
  BOOST_TEST(shares == 1);
}

// Balanced by the estimated work, to within the longest job.
BOOST_AUTO_TEST_CASE(shares_are_of_about_the_same_work) {
  const Results grid = planned(100, false);
  double all = 0, longest = 0;
  const auto work = [](const CaseResult& result, const Cell& cell) {
    return 2e4 + result.definition.duration / cell.dt.seconds;
  };
  for (const CaseResult& result : grid.cases) {
    for (const Cell& cell : result.cells) all += work(result, cell), longest = std::max(longest, work(result, cell));
  }
  for (int k = 1; k <= 4; ++k) {
    double share = 0;
    for (const CaseResult& result : share_of(grid, {k, 4}).cases) {
      for (const Cell& cell : result.cells) share += cell.status == Status::crashed ? work(result, cell) : 0;
    }
    // Truths are of the work as well, one a case; a share begins and ends within a job.
    BOOST_TEST(std::abs(share - all / 4) <= 2 * longest + 2e4 * 2, "shard " << k << ": " << share << " of " << all);
  }
}

// A million steps are a share by themselves, and two short cells and the truth the other.
BOOST_AUTO_TEST_CASE(a_cell_of_many_steps_outweighs_those_of_few) {
  const EngineTable table = one_engine();
  Case definition = drifting_body("case");
  definition.dt.push_back({1e-6, "1/1000000"});
  const Results grid = plan_grid({definition}, {parse_run_name("good", table.infos())}, table, {false});
  BOOST_TEST_REQUIRE(grid.cases[0].cells.size() == 3u);
  for (const int k : {1, 2}) {
    const Results share = share_of(grid, {k, 2});
    for (const Cell& cell : share.cases.at(0).cells)
      BOOST_TEST((cell.status == Status::crashed) == (k == (cell.dt.seconds < 1e-5 ? 2 : 1)), cell.dt.text);
  }
}

BOOST_AUTO_TEST_CASE(a_thousand_parts_are_merged_in_seconds_to_the_very_same_report) {
  constexpr int kShards = 1000;
  const EngineTable table = one_engine();
  Folder folder;
  const Results grid = planned(200, false);
  GridOptions options;
  options.jobs = 2, options.stable_steps = false, options.is_thorough = false;
  Results whole = grid;
  for (CaseResult& result : whole.cases) {  // as if it had run
    result.truth = TruthFacts{1e-12, 1, 2, 3};
    for (Cell& cell : result.cells) {
      cell.status = Status::pass, cell.reason.clear(), cell.cpu_seconds = 0.1 + cell.dt.seconds / 3;
      MetricValue& error = cell.metrics["position_error"];
      error.value = cell.dt.seconds / 7, error.compared_until = 1;
    }
  }
  const auto plans = plans_of(grid, table, options);
  for (int k = 1; k <= kShards; ++k) {
    const Results share = share_of(grid, {k, kShards});
    Results done = share;
    for (CaseResult& result : done.cases) {
      const CaseResult& ran = whole.cases[std::stoul(result.definition.id.substr(5))];
      result.truth = ran.truth;
      for (std::size_t i = 0; i < result.cells.size(); ++i) {
        if (result.cells[i].status == Status::crashed) result.cells[i] = ran.cells[i];
      }
    }
    folder.write(fmt::format("{}/{}", k, kPartFile),
                 part_text({{k, kShards}, "1", "b", {"run"}, "", "", plans, 0}, share, done, table, options));
  }
  const auto begin = std::chrono::steady_clock::now();
  std::vector<Part> parts;
  for (int k = kShards; k >= 1; --k) parts.push_back(read_part((folder.path / std::to_string(k)).string()));
  check_same_grid(parts);
  Results merged = grid;
  const Merged found = fill_in(merged, parts);
  const std::string report = json_report(merged);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  BOOST_TEST(found.missing.empty());
  BOOST_TEST((report == json_report(whole)));
  BOOST_TEST(seconds < 5, "a goal for the release build: " << seconds << " s");
  BOOST_TEST_MESSAGE("merge of 1000 parts: " << seconds << " s");
}

BOOST_AUTO_TEST_SUITE_END()
