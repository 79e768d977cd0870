// Answers to `reactions`: what is taken, and what is refused with the reason.
#include "adapters/plugin/answer.h"

#include <boost/test/unit_test.hpp>
#include <string>

#include "core/base/json.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_plugin_answer)

namespace {

std::vector<ReportedReaction> read(const std::string& list, std::size_t joints) {
  return read_reactions(parse_json(R"({"ok":true,"reactions":)" + list + "}"), {"toy", "reactions", 1}, joints, 3);
}

const std::string kGood = R"({"body":2,"force":[1,2,3],"torque":[4,5,6.5]})";

}  // namespace

BOOST_AUTO_TEST_CASE(reactions_are_read) {
  const auto found = read("[" + kGood + "]", 1);
  BOOST_TEST_REQUIRE(found.size() == 1u);
  BOOST_TEST(found[0].body == 2);
  BOOST_TEST((found[0].force == Vec3(1, 2, 3) && found[0].torque == Vec3(4, 5, 6.5)));
  BOOST_TEST(read("[]", 0).empty());
}

BOOST_AUTO_TEST_CASE(reactions_of_another_form_are_refused) {
  struct Bad {
    std::string list, says;
  };
  for (const Bad& bad :
       {Bad{"{}", "its reactions are no list"}, Bad{"[]", "its reactions are 0; one for each of 1 joints is due"},
        Bad{"[" + kGood + "," + kGood + "]", "its reactions are 2"}, Bad{"[7]", "body of reaction 0 is not there"},
        Bad{R"([{"body":3,"force":[1,2,3],"torque":[4,5,6]}])", "body of reaction 0 is '3'"},
        Bad{R"([{"body":-1,"force":[1,2,3],"torque":[4,5,6]}])", "body of reaction 0 is '-1'"},
        Bad{R"([{"body":0,"force":[1,2],"torque":[4,5,6]}])", "force of reaction 0 is '[1,2]'"},
        Bad{R"([{"body":0,"force":[1,2,3],"torque":[4,5,null]}])", "torque of reaction 0"}}) {
    BOOST_CHECK_EXCEPTION(read(bad.list, 1), EngineFailure, [&](const EngineFailure& failure) {
      const std::string said = failure.what();
      BOOST_TEST_MESSAGE(said);
      return failure.kind() == FailureKind::invalid && said.find(bad.says) != std::string::npos;
    });
  }
}

BOOST_AUTO_TEST_SUITE_END()
