#include "cases/case/case.h"

#include <boost/test/unit_test.hpp>

#include "tests/core/scene/toml/refusal.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_case_case)

BOOST_AUTO_TEST_CASE(a_step_size_is_a_number_or_a_fraction_and_keeps_its_text) {
  const std::vector<std::pair<std::string, double>> rows = {{"0.01", 0.01},     {"1", 1},         {"1e-3", 1e-3},
                                                            {"1/30", 1.0 / 30}, {"1/1000", 1e-3}, {"0.5/2", 0.25},
                                                            {"5e-324", 5e-324}};
  for (const auto& [text, seconds] : rows) {
    BOOST_TEST(parse_step_size(text, "--dt").seconds == seconds);
    BOOST_TEST(parse_step_size(text, "--dt").text == text);
  }
}

BOOST_AUTO_TEST_CASE(a_step_is_the_same_however_it_is_written_and_another_is_not) {
  const auto step = [](const std::string& text) { return parse_step_size(text, "--dt"); };
  for (const std::string text : {"0.033333333333333", "0.03333333333", "33.3333333333e-3", "2/60"}) {
    BOOST_TEST((step("1/30") == step(text)), text);
    BOOST_TEST((step(text) == step("1/30")), text);
  }
  for (const std::string text : {"0.0333333", "1/31", "1/3000", "0.0333333334", "1/30.0000001"}) {
    BOOST_TEST((step("1/30") != step(text)), text);
    BOOST_TEST((step(text) != step("1/30")), text);
  }
  BOOST_TEST((step("5e-324") != step("1e-323")));
}

BOOST_AUTO_TEST_CASE(anything_else_is_refused_with_what_was_found) {
  for (const std::string text :
       {"",      " ",      "0",   "-1",  "nan",    "inf",          "-inf",         "1e999", "1e-999",  "abc",
        "1/",    "/30",    "1/0", "0/1", "-1/-30", "1/-30",        "-1/30",        "1/inf", "inf/inf", "1/nan",
        "1/2/3", "1 / 30", " 1",  "1s",  "0x10",   "1e300/1e-300", "1e-300/1e300", "1,5",   "½"}) {
    BOOST_TEST(refusal_of([&] { parse_step_size(text, "--dt"); }) ==
               "--dt: found '" + text +
                   "'; allowed: a number of seconds greater than 0, as 0.01, or a fraction, as 1/30");
  }
}

BOOST_AUTO_TEST_CASE(a_long_or_unprintable_step_size_is_not_repeated_whole) {
  const auto message_for = [](const std::string& text) { return refusal_of([&] { parse_step_size(text, "--dt"); }); };
  BOOST_TEST(message_for("0." + std::string(1'000'000, '1')).size() < 200u);
  BOOST_TEST(message_for("1\x1b[31m").starts_with("--dt: found '1?[31m'"));
}

BOOST_AUTO_TEST_CASE(a_step_must_fit_into_the_run_a_countable_number_of_times) {
  BOOST_TEST(refusal_of([] { check_step_size({5, "5"}, 5, "--dt"); }) == "");
  BOOST_TEST(refusal_of([] {
               check_step_size({1e300, "1e300"}, 5, "--dt");
             }) == "--dt: found a step of 1e300 s, longer than the run; allowed: at most 5 s");
  BOOST_TEST(refusal_of([] {
               check_step_size({1e-300, "1e-300"}, 5, "--dt");
             }).ends_with("5e+300; allowed: at most 1e+12 steps"));
}

BOOST_AUTO_TEST_SUITE_END()
