// The calls to paste: no option of an engine that has calls at all is lost in them.
#include "adapters/engines.h"

#include <boost/test/unit_test.hpp>
#include <set>


using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_calls)

BOOST_AUTO_TEST_CASE(every_option_and_choice_is_a_call_of_its_own) {
  int asked = 0;
  for (const EngineInfo& engine : engines().infos()) {
    if (engine.is_in_house) continue;
    for (const MethodInfo& method : engine.methods) {
      RunName run{engine.name, {method.name, {}, Track::matched}, engine.name};
      BOOST_TEST(!engine_calls(run, "1.0 / 60").empty(), engine.name);
      BOOST_TEST(engine_calls(run, "1.0 / 60").back().find("1.0 / 60") != std::string::npos);
      for (const OptionInfo& option : method.options) {
        std::set<std::vector<std::string>> different;
        const std::vector<std::string> values =
            option.choices.empty() ? std::vector<std::string>{"1", "0.5"} : option.choices;
        for (const std::string& value : values) {
          run.settings.options = {{option.name, value}};
          different.insert(engine_calls(run, "1.0 / 60"));
          ++asked;
        }
        BOOST_TEST(different.size() == values.size(), engine.name + ":" + method.name + " " + option.name);
      }
    }
  }
  BOOST_TEST(asked > 20);
}

BOOST_AUTO_TEST_CASE(each_method_has_calls_of_its_own) {
  int asked = 0;
  for (const EngineInfo& engine : engines().infos()) {
    if (engine.is_in_house) continue;
    for (const Track track : {Track::matched, Track::stock}) {
      std::set<std::vector<std::string>> different;
      for (const MethodInfo& method : engine.methods)
        different.insert(engine_calls(RunName{engine.name, {method.name, {}, track}, engine.name}, "1.0 / 60"));
      BOOST_TEST(different.size() == engine.methods.size(), engine.name);
      ++asked;
    }
  }
  BOOST_TEST(asked >= 4);
}

// A btMultiBody has no such members.
BOOST_AUTO_TEST_CASE(bullets_trees_get_no_calls_of_its_rigid_bodies) {
  for (const Track track : {Track::matched, Track::stock}) {
    std::string text;
    for (const std::string& call : engine_calls(RunName{"bullet", {"multibody", {}, track}, "bullet"}, "1.0 / 60"))
      text += call + "\n";
    for (const char* other : {"setActivationState", "body->setDamping", "setFlags", "m_splitImpulse", "Gyroscopic"})
      BOOST_TEST(text.find(other) == std::string::npos, text);
    BOOST_TEST(text.find("new btMultiBodyDynamicsWorld(") != std::string::npos, text);
    BOOST_TEST((text.find("body->setLinearDamping(0);") != std::string::npos) == (track == Track::matched), text);
  }
}

BOOST_AUTO_TEST_CASE(an_engine_without_calls_has_none) {
  BOOST_TEST(engine_calls(RunName{"core", {"rk4", {}, Track::matched}, "core:rk4"}, "1.0 / 60").empty());
}

BOOST_AUTO_TEST_SUITE_END()
