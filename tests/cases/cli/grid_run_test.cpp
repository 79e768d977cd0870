// The runs that a command selects.
#include "cases/cli/grid_run.h"

#include <boost/test/unit_test.hpp>

#include "tests/cases/vocabulary.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_cli_grid_run)

BOOST_AUTO_TEST_CASE(what_runs_on_request_takes_part_where_it_is_named) {
  EngineOptions options;
  for (const RunName& run : runs_asked_for(options, test::words().engines)) BOOST_TEST(!is_on_request(run.engine));
  for (const EngineOnRequest& row : engines_on_request()) {
    BOOST_TEST(!row.why.empty());
    const auto& infos = infos_of(engines());
    const bool is_built = std::any_of(infos.begin(), infos.end(), [&](const auto& i) { return i.name == row.name; });
    if (!is_built) continue;
    options.engines = {row.name};
    BOOST_TEST(runs_asked_for(options, test::words().engines).size() == 1u);
  }
}

BOOST_AUTO_TEST_CASE(a_run_that_names_no_engine_says_which_it_leaves_out) {
  EngineOptions options;
  std::vector<EngineInfo> infos(2);
  infos[0].name = "ode", infos[1].name = engines_on_request().front().name;
  BOOST_TEST(left_out_by_default(options, infos) == infos[1].name);
  options.engines = {"ode"};
  BOOST_TEST(left_out_by_default(options, infos) == "");
  options.engines.clear(), infos.pop_back();
  BOOST_TEST(left_out_by_default(options, infos) == "");  // a build without it
}

BOOST_AUTO_TEST_SUITE_END()
