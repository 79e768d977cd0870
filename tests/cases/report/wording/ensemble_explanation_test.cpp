// Which runs end where the reference does, and which do not.
#include "cases/report/wording/explanations/ensemble_explanation.h"

#include <boost/test/unit_test.hpp>

#include "tests/cases/report/sample_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_wording_ensemble_explanation)

namespace {

Results with(double p_of_good, double p_of_wild, bool good_is_own = false) {
  Results grid = sample_results();
  CaseResult& result = grid.cases.front();
  result.definition.ensemble = 50;
  for (Cell& cell : result.cells) {
    cell.metrics["ensemble_distance"] = sample_metric(0.25, {});
    cell.metrics["ensemble_p_value"] = sample_metric(cell.run == 0 ? p_of_good : p_of_wild, {});
    cell.metrics["ensemble_p_value"].is_held_to_itself = good_is_own && cell.run == 0;
  }
  return grid;
}

std::string said_of(const Results& grid) {
  std::string text;
  for (const Message& message : ensemble_explanations(grid, grid.cases.front())) text += message.text + "\n";
  return text;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_run_differs_where_chance_would_hardly_part_so_far) {
  BOOST_TEST(
      said_of(with(0.5, 0.001)) ==
      "Final places are distributed differently from the reference's (energy distance H, chance p). Ensemble of 50 "
      "starts at dt = 1/10 s: wild (H = 0.25, p = 0.001).\n"
      "Final places cannot be told from the reference's (energy distance H, chance p). Ensemble of 50 starts at dt = "
      "1/10 s: good (H = 0.25, p = 0.5).\n");
  BOOST_TEST(said_of(with(0.0099, 0.01))
                 .find("differently from the reference's (energy distance H, chance p). Ensemble of "
                       "50 starts at dt = 1/10 s: good (H = 0.25, p = 0.0099).") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(the_references_own_code_is_no_check_of_it) {
  const std::string said = said_of(with(0.5, 0.5, true));
  BOOST_TEST(
      said.find("is no independent check of it. Ensemble of 50 starts at dt = 1/10 s: good (") != std::string::npos,
      said);
  Results grid = with(0.5, 0.5);
  grid.cases[0].cells[0].metrics["ensemble_distance"].not_applicable = "it blew up";
  BOOST_TEST(said_of(grid).find("No ensembles compared (it blew up): good.") != std::string::npos);
  grid.cases[0].definition.ensemble = 0;
  BOOST_TEST(said_of(grid) == "");
}

BOOST_AUTO_TEST_SUITE_END()
