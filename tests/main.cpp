#define BOOST_TEST_MODULE rigor
#include <boost/test/unit_test.hpp>
#include <cstdlib>

// The tests compute what they test: no reference solution kept from an earlier run.
struct NoCache {
  NoCache() { setenv("RIGOR_CACHE_DIR", "", 1); }
};
BOOST_TEST_GLOBAL_FIXTURE(NoCache);
