#include <boost/test/unit_test.hpp>

#include "core/base/error.h"
#include "tests/cases/judged.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_truths)

namespace {

// An error that doubles each second from 1e-9.
class Doubling : public Truth {
 public:
  void at(double, MutableBodyColumns) const override {}
  double error(double t) const override { return 1e-9 * std::exp2(t); }
};

}  // namespace

BOOST_AUTO_TEST_CASE(the_table_is_alphabetical_and_each_row_says_what_it_is) {
  for (std::size_t i = 0; i < truths().size(); ++i) {
    BOOST_TEST(!truths()[i].summary.empty());
    if (i > 0) BOOST_TEST((truths()[i - 1].name < truths()[i].name));
  }
}

BOOST_AUTO_TEST_CASE(none_is_no_truth_and_an_unknown_one_names_its_near_match) {
  BOOST_TEST(make_truth("none", test::fixed_spring(), 1) == nullptr);
  BOOST_CHECK_EXCEPTION(make_truth("referense", test::fixed_spring(), 1), InputError, test::says("'reference'"));
}

BOOST_AUTO_TEST_CASE(the_horizon_is_where_the_error_passes_the_tolerance) {
  BOOST_TEST(horizon(Doubling(), 1e-8, 30) == std::log2(10), boost::test_tools::tolerance(1e-12));  // rounding
  BOOST_TEST(horizon(Doubling(), 1e-8, 2) == 2);
  BOOST_TEST(horizon(Doubling(), 1e-10, 30) == 0);
}

BOOST_AUTO_TEST_SUITE_END()
