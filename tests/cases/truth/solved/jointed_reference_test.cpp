// The reference of jointed scenes against states that others found: published.json holds, for cases of the suite, states
// by three derivations written apart (maximal coordinates, Kane's equations, closed forms), with their own errors.
#include <boost/test/unit_test.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cases/case/suite.h"
#include "cases/truth/truth.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_solved_jointed_reference)

