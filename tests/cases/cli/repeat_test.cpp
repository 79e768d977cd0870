// rigor repeat, by the program itself: a new process, hashes in a file, exit codes.
#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "tests/cases/cli/program.h"

using namespace rigor;
using Json = nlohmann::json;

namespace {

struct RepeatFixture : Program {
  RepeatFixture() { folder.write("cube.toml", kSprungCube); }
};

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

BOOST_FIXTURE_TEST_SUITE(cases_cli_repeat, RepeatFixture)

BOOST_AUTO_TEST_CASE(the_core_repeats_also_in_a_new_process) {
  const Answer answer = run({"repeat", "cube.toml", "--engine", "core:rk4", "--json"});
  BOOST_TEST_REQUIRE(answer.code == 0, answer.out + answer.err);
  const Json report = Json::parse(answer.out)[0];
  BOOST_TEST(report.at("repeats") == true);
  std::string ran;
  for (const Json& change : report.at("changes")) {
    if (change.at("status") == "same-bits") ran += change.at("change").get<std::string>() + " ";
  }
  BOOST_TEST(holds(ran, "again new-process after-another beside-another threads threads threads lanes "), ran);
  BOOST_TEST(holds(ran, "copies"), ran);
}

BOOST_AUTO_TEST_CASE(hashes_agree_with_themselves_and_not_with_another_motion) {
  BOOST_TEST(run({"repeat", "cube.toml", "--engine", "core:rk4", "--record", "a.jsonl"}).code == 0);
  const Answer same = run({"repeat", "cube.toml", "--engine", "core:rk4", "--against", "a.jsonl"});
  BOOST_TEST(same.code == 0, same.err);
  BOOST_TEST(holds(same.out, "same bits in 150 steps"), same.out);
  BOOST_TEST(run({"repeat", "cube.toml", "--engine", "ode", "--against", "a.jsonl"}).code == 2);
  std::string text = content("a.jsonl");
  const std::size_t digit = text.find("\"hashes\":\"") + 10 + 16 * 7;
  text[digit] = text[digit] == '0' ? '1' : '0';
  folder.write("b.jsonl", text);
  const Answer other = run({"repeat", "cube.toml", "--engine", "core:rk4", "--against", "b.jsonl"});
  BOOST_TEST(other.code == 1, other.out);
  BOOST_TEST(holds(other.out, "DIFFERS from step 7 on"), other.out);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_repeated_is_refused) {
  BOOST_TEST(run({"repeat", "--engine", "ode"}).code == 2);
  BOOST_TEST(run({"repeat", "cube.toml", "--engine", "ode", "--record", "a", "--against", "b"}).code == 2);
  BOOST_TEST(run({"repeat", "cube.toml", "--engine", "ode", "--against", "absent.jsonl"}).code == 2);
  folder.write("no.jsonl", "no record");
  const Answer answer = run({"repeat", "cube.toml", "--engine", "ode", "--against", "no.jsonl"});
  BOOST_TEST(answer.code == 2);
  BOOST_TEST(holds(answer.err, "no.jsonl:1: not a record of hashes"), answer.err);
}

BOOST_AUTO_TEST_SUITE_END()
