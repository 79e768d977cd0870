// Results belong to this program and its linked libraries.
#include "cases/runner/build_identity.h"

#include <fmt/format.h>
#include <boost/test/unit_test.hpp>

#include "core/base/content_hash.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_build_identity)

BOOST_AUTO_TEST_CASE(it_is_neither_of_nothing_nor_of_the_program_alone) {
  const std::string program = "/proc/self/exe";
  BOOST_TEST(build_identity().size() == 16u);
  BOOST_TEST(build_identity() != fmt::format("{:016x}", kHashOfNothing));
  BOOST_TEST(build_identity() != fmt::format("{:016x}", hash_of_file(program, content_hash(program, kHashOfNothing))));
  BOOST_TEST(build_identity() == build_identity());
}

BOOST_AUTO_TEST_SUITE_END()
