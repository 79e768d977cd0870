// Solved truths under exact relations between scenes (relations.h). Two related truths may be apart by what both claim.
#include <boost/test/unit_test.hpp>

#include "tests/relations/comparison.h"
#include "tests/relations/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(relations_truths)

BOOST_AUTO_TEST_CASE(the_reference_keeps_relations_within_its_claims) {
  test::check(test::run_of_truth("reference", 0.2, 4), "smooth", 2);
  test::check(test::run_of_truth("reference", 0.2, 4), "mechanisms", 4);
  test::check(test::run_of_truth("reference", 0.2, 4), "compound joints", 4);
}

BOOST_AUTO_TEST_CASE(the_truth_by_events_keeps_relations_within_its_claims) {
  for (const auto& [scenes, count] : {std::pair("on a plane", 6),
                                      {"in flight", 2},
                                      {"cylinders", 3},
                                      {"line contacts", 2},
                                      {"once contradicted", test::kContradicted}})
    test::check(test::run_of_truth("events", 0.8, 4), scenes, count);
}

BOOST_AUTO_TEST_SUITE_END()
