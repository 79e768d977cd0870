// How a sweep hands its cells to whoever does them.
#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "cases/analysis/sweep/sweep.h"
#include "cases/case/suite.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_sweep_run)

namespace {

// Lets the first job end when no other is left, as on a cluster where one cell takes as long as all others.
class FirstEndsLast : public Executor {
 public:
  using Executor::run;
  void run(JobSource& jobs, const Work&, const OnMessage&, const OnEnd& on_end) const override {
    ++calls;
    for (std::size_t number = 0; jobs.next(); ++number) {
      if (number > 0) on_end(number, {});
      done = number + 1;
    }
    if (done > 0) on_end(0, {});
  }
  mutable std::size_t calls = 0, done = 0;
};

}  // namespace

// At such a barrier 64 ranks stood still for a fifth of a minute's sweep.
BOOST_AUTO_TEST_CASE(no_cell_waits_for_another_one_to_end) {
  SweepInput input;
  input.cases = select_cases({"springs/fixed-spring"}, default_suite_dir(), test::words());
  input.runs = {parse_run_name("ode", test::words().engines)};
  input.axes = {parse_axis("scene.spring[0].stiffness=1e2..3e2:6000", false), parse_axis("dt=1/30", false)};
  const Sweep sweep(input, test::words());
  const FirstEndsLast executor;
  std::vector<std::string> rows;
  SweepOptions options;
  options.executor = &executor;
  run_sweep(sweep, engines(), options, [&](const SweepRow& row) { rows.push_back(row.values.front()); });
  BOOST_TEST(executor.calls == 1u);
  BOOST_TEST(executor.done == 6000u);
  BOOST_TEST_REQUIRE(rows.size() == 6000u);  // and they come in their order
  BOOST_TEST(rows.front() == "100");
  BOOST_TEST(rows.back() == "300");
}

// Though all of a scene's cells could share one truth, no shard of a small sweep is left without work.
BOOST_AUTO_TEST_CASE(few_cells_of_one_scene_are_dealt_to_all_shards_alike) {
  SweepInput input;
  input.cases = select_cases({"springs/fixed-spring"}, default_suite_dir(), test::words());
  input.runs = {parse_run_name("ode", test::words().engines)};
  for (const int cells : {6, 100, 1000}) {
    input.axes = {parse_axis(fmt::format("dt=0.001..0.1:log:{}", cells), false)};
    const Sweep sweep(input, test::words());
    std::size_t all = 0;
    for (int k = 1; k <= 3; ++k) {
      const auto [first, behind] = jobs_of(sweep, Shard{k, 3});
      const std::size_t rows = sweep.first_row_of(behind) - sweep.first_row_of(first);
      BOOST_TEST(std::abs(static_cast<double>(rows) - cells / 3.0) <= static_cast<double>(kRowsOfJob));
      BOOST_TEST(rows > 0u);
      all += rows;
    }
    BOOST_TEST(all == static_cast<std::size_t>(cells));
  }
}

BOOST_AUTO_TEST_SUITE_END()
