#include "cases/case/run_selector.h"

#include <boost/test/unit_test.hpp>

#include "core/base/error.h"
#include "tests/core/scene/toml/refusal.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_case_run_selector)

namespace {

MethodInfo method(const std::string& name, int order, bool symplectic, const std::string& twin_of = "") {
  MethodInfo info;
  info.name = name, info.order = order, info.symplectic = symplectic, info.twin_of = twin_of;
  info.options = {{.name = "contact", .meaning = "", .choices = {"event", "impulse"}}};
  return info;
}

// A core of four methods, the last a twin of "toy"; and two other engines.
std::vector<EngineInfo> infos() {
  EngineInfo core{.name = "core", .version = "1", .precision = "double"};
  core.is_in_house = true;
  core.methods = {method("euler", 1, true), method("rk4", 4, false), method("adaptive8", 8, false),
                  method("toy-twin", 1, false, "toy")};
  core.methods[2].adaptive = true;
  core.methods[1].options.clear();
  EngineInfo toy{.name = "toy", .version = "1", .precision = "double"}, other = toy;
  toy.methods = {method("fast", 1, false), method("slow", 1, false)};
  other.name = "other", other.methods = {method("only", 2, true)};
  return {core, other, toy};
}

std::string selected(const std::string& selector) {
  std::string names;
  for (const std::string& name : selected_runs(selector, infos())) names += (names.empty() ? "" : " ") + name;
  return names;
}

}  // namespace

BOOST_AUTO_TEST_CASE(runs_are_selected_by_name_and_by_what_they_are) {
  const std::pair<const char*, const char*> rows[] = {
      {"core:*", "core:euler core:rk4 core:adaptive8"},  // no twin: it is an instrument
      {"toy*", "toy toy@stock"},
      {"toy:fast", "toy toy@stock"},
      {"toy:f*t @matched", "toy"},
      {"*", "core:euler core:rk4 core:adaptive8 other other@stock toy toy@stock"},
      {"@stock", "other@stock toy@stock"},
      {"toy*@stock", "toy@stock"},
      {"twin", "toy toy@stock"},
      {"symplectic", "core:euler other other@stock"},
      {"adaptive", "core:adaptive8"},
      {"order>=4", "core:rk4 core:adaptive8"},
      {"order>4", "core:adaptive8"},
      {"order=2", "other other@stock"},
      {"order<2", "core:euler toy toy@stock"},
      {"order<=2 core:*", "core:euler"},
      {"order>=4 !adaptive", "core:rk4"},
      {"core:* !core:rk4", "core:euler core:adaptive8"},
      {"toy*,contact=event", "toy,contact=event toy,contact=event@stock"},
      {"core:*,contact=event", "core:euler,contact=event core:adaptive8,contact=event"},  // rk4 has no such option
  };
  for (const auto& [selector, names] : rows)
    BOOST_TEST(selected(selector) == names, selector << ": " << selected(selector));
}

BOOST_AUTO_TEST_CASE(stars_stand_for_any_letters) {
  BOOST_TEST(selected("core:*") == "core:euler core:rk4 core:adaptive8");
  BOOST_TEST(selected("core:*r*") == "core:euler core:rk4");
  BOOST_TEST(selected("core:**rk**4**") == "core:rk4");
  BOOST_TEST(selected("*:*a*e*8*") == "core:adaptive8");
  // Letters count once: none is both before a star and behind it.
  for (const char* none : {"core:rk4*4", "core:*k4*k4", "core:*4*rk*", "core:*rk4x*"})
    BOOST_CHECK_THROW(selected(none), InputError);
}

// Each star doubled the time once.
BOOST_AUTO_TEST_CASE(many_stars_take_no_time) {
  std::string stars;
  for (int n = 0; n < 10000; ++n) stars += n % 3 == 0 ? "*" : "*e*";
  BOOST_CHECK_THROW(selected("core:" + stars + "x"), InputError);
  BOOST_CHECK_THROW(selected("core:adaptive8" + std::string(10000, '*') + "x"), InputError);
}

BOOST_AUTO_TEST_CASE(a_name_of_one_run_is_no_selector) {
  for (const char* name : {"core:rk4", "toy", "toy@stock", "core:rk4,contact=event", "toy,contact=event@stock"})
    BOOST_TEST(!is_run_selector(name), name);
  for (const char* text : {"core:*", "order>=4", "symplectic", "@stock", "twin", "!toy", "core:rk4 twin"})
    BOOST_TEST(is_run_selector(text), text);
}

BOOST_AUTO_TEST_CASE(what_selects_nothing_is_refused) {
  const std::pair<const char*, const char*> rows[] = {
      {"core:* symplektic", "did you mean 'symplectic'?"},
      {"order>=9", "selects no run"},
      {"order~4", "'order~4' says nothing about a run"},
      {"order>=", "'order>=' says nothing about a run"},
      {"order>=4x", "says nothing about a run"},
      {"@stok", "'@stok' says nothing about a run"},
      {"cor:*", "selects no run"},
      {"core:*,contact=evnt", "did you mean 'event'?"},
  };
  for (const auto& [selector, part] : rows) {
    const std::string refusal = refusal_of([&] { selected_runs(selector, infos()); });
    BOOST_TEST(refusal.find(part) != std::string::npos, selector << ": " << refusal);
  }
}

BOOST_AUTO_TEST_SUITE_END()
