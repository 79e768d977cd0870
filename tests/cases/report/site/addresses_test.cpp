// The addresses of the site: safe file names that no two names share.
#include "cases/report/site/addresses.h"

#include <boost/test/unit_test.hpp>
#include <set>
#include <string>
#include <vector>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_site_addresses, *boost::unit_test::enable_if<RIGOR_HTML_REPORT>())

BOOST_AUTO_TEST_CASE(usual_names_stay_as_they_are) {
  BOOST_TEST(case_page_address("springs/fixed-spring") == "cases/springs/fixed-spring.html");
  BOOST_TEST(engine_page_address("ode") == "engines/ode.html");
  BOOST_TEST(badge_address("core:rk4") == "badge/core~3Ark4.svg");
  BOOST_TEST(metric_page_address("position_error") == "metrics/position_error.html");
  BOOST_TEST(case_data_address("my.scene") == "api/cases/my.scene.json");
  BOOST_TEST(engine_data_address("mujoco-js") == "api/engines/mujoco-js.json");
}

BOOST_AUTO_TEST_CASE(no_two_names_share_a_file_and_none_leaves_its_folder) {
  const std::string longest(400, 'a');
  const std::vector<std::string> names = {
      "a",        "a~",         "a~2F",   "a/b",         "a~2Fb", "a:b",  "a~3Ab", "",      "/",
      "..",       "../..",      "~",      "../../etc",   "/a",    "a/",   "a//b",  ".a",    "~2Ea",
      "a.html/b", "a~2Ehtml/b", "a.html", "\"><script>", "a b",   "a\nb", "ä",     longest, longest + "b"};
  std::set<std::string> files;
  for (const std::string& name : names) {
    const std::string address = case_page_address(name);
    BOOST_TEST(files.insert(address).second, name + " has the address of another: " + address);
    BOOST_TEST(address.find("/.") == std::string::npos, address);
    BOOST_TEST(address.find("//") == std::string::npos, address);
    for (const char c : address)
      BOOST_TEST(
          (std::isalnum(static_cast<unsigned char>(c)) != 0 || std::string("~/._-").find(c) != std::string::npos),
          address);
    for (const std::string& other : files)
      BOOST_TEST((address == other || !address.starts_with(other + "/")), address + " lies in the file " + other);
    BOOST_TEST(address.size() < 255u);
  }
}

BOOST_AUTO_TEST_CASE(pages_find_the_way_back) {
  BOOST_TEST(back_to_root("index.html") == "");
  BOOST_TEST(back_to_root("engines/ode.html") == "../");
  BOOST_TEST(back_to_root(case_page_address("a/b/c")) == "../../../");
}

BOOST_AUTO_TEST_SUITE_END()
