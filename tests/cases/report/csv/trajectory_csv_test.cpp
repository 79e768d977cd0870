#include "cases/report/csv/trajectory_csv.h"

#include <boost/test/unit_test.hpp>
#include <cstdlib>
#include <sstream>

#include "tests/folder.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_csv_trajectory_csv)

BOOST_AUTO_TEST_CASE(a_name_is_quoted_only_where_it_must_be) {
  BOOST_TEST(csv_field("cube 1") == "cube 1");
  BOOST_TEST(csv_field("a,b") == "\"a,b\"");
  BOOST_TEST(csv_field("12\" disc") == "\"12\"\" disc\"");
  BOOST_TEST(csv_field("two\nlines") == "\"two\nlines\"");
}

BOOST_AUTO_TEST_CASE(the_columns_are_those_of_the_design) {
  BOOST_TEST(csv_header() == "time,body,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz");
}

BOOST_AUTO_TEST_CASE(reading_gives_the_same_doubles_again) {
  Scene scene;
  scene.bodies.resize(2);
  scene.bodies[0].name = "a", scene.bodies[1].name = "b,c";
  BodyTable table(2);
  double value = 1.0 / 3;
  for (int c = 0; c < 13; ++c) {
    for (int i = 0; i < 2; ++i) table.columns().column(c)[i] = value *= -1.7;
  }
  const double time = 0.1 + 0.2;
  std::string rows;
  append_csv_rows(rows, scene, time, table.columns(), ",7");
  std::istringstream lines(rows);
  for (int i = 0; i < 2; ++i) {
    std::string line;
    BOOST_TEST_REQUIRE(static_cast<bool>(std::getline(lines, line)));
    const std::string name = i == 0 ? ",a," : ",\"b,c\",";
    const std::size_t at = line.find(name);
    BOOST_TEST_REQUIRE(at != std::string::npos);
    BOOST_TEST(std::strtod(line.c_str(), nullptr) == time);
    const char* next = line.c_str() + at + name.size();
    for (int c = 0; c < 13; ++c) {
      char* end = nullptr;
      BOOST_TEST(std::strtod(next, &end) == table.columns().column(c)[i]);
      next = end + 1;
    }
    BOOST_TEST(std::string(next) == "7");
  }
}

BOOST_AUTO_TEST_CASE(a_file_that_cannot_be_written_is_an_error) {
  const Folder folder;
  BOOST_CHECK_THROW(write_trajectory((folder.path / "no" / "such.csv").string(), {}, {}), std::runtime_error);
  BOOST_CHECK_THROW(write_trajectory("/dev/full", {}, {}), std::runtime_error);
}

BOOST_AUTO_TEST_SUITE_END()
