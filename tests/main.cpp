#define BOOST_TEST_MODULE rigor
#include <boost/test/unit_test.hpp>
