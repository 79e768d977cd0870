#include "core/engine/run_name.h"

#include <boost/test/unit_test.hpp>

#include "core/base/error.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_engine_run_name)

namespace {

std::vector<EngineInfo> two_engines() {
  OptionInfo iterations{
      .name = "iterations", .meaning = "of the solver", .min = 1, .max = 1000, .whole = true, .by_default = 20.0};
  OptionInfo orientation{.name = "orientation",
                         .meaning = "update",
                         .choices = {"matrix", "quaternion"},
                         .by_default = "quaternion",
                         .as_shipped = "matrix"};
  EngineInfo core{.name = "core", .version = "1", .precision = "double"};
  core.methods = {{.name = "euler", .summary = "", .options = {orientation}}, {.name = "rk4", .summary = ""}};
  EngineInfo ode{.name = "ode", .version = "1", .precision = "double"};
  ode.methods = {{.name = "quickstep", .summary = "", .options = {iterations}}};
  return {core, ode};
}

std::string error_of(const std::string& text) {
  try {
    parse_run_name(text, two_engines());
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_full_name_is_taken_apart) {
  const RunName run = parse_run_name("ode:quickstep,iterations=50@stock", two_engines());
  BOOST_TEST(run.engine == "ode");
  BOOST_TEST(run.settings.method == "quickstep");
  BOOST_TEST(run.settings.options.at("iterations") == "50");
  BOOST_TEST((run.settings.track == Track::stock));
}

BOOST_AUTO_TEST_CASE(an_engine_alone_means_its_first_method_matched) {
  const RunName run = parse_run_name("core", two_engines());
  BOOST_TEST(run.settings.method == "euler");
  BOOST_TEST((run.settings.track == Track::matched));
  BOOST_TEST(parse_run_name("ode,iterations=3", two_engines()).settings.method == "quickstep");
}

BOOST_AUTO_TEST_CASE(a_number_is_the_same_value_however_it_is_written) {
  for (const char* value : {"50", "050", "50.0", "5e1"}) {
    const RunName run = parse_run_name(std::string("ode:quickstep,iterations=") + value, two_engines());
    BOOST_TEST(run.settings.options.at("iterations") == "50");
  }
}

BOOST_AUTO_TEST_CASE(what_is_wrong_is_said_with_what_may_have_been_meant) {
  const std::pair<const char*, std::vector<const char*>> rows[] = {
      {"cor", {"no engine 'cor'", "did you mean 'core'", "core, ode"}},
      {"", {"no engine ''", "core, ode"}},
      {"core:rk5", {"no method of core called 'rk5'", "did you mean 'rk4'", "euler, rk4"}},
      {"core:", {"no method of core called ''"}},
      {"ode:quickstep,iteration=5", {"no option of ode:quickstep called 'iteration'", "did you mean 'iterations'"}},
      {"core:rk4,orientation=matrix", {"no option of core:rk4 called 'orientation'", "there is: none"}},
      {"core:euler,orientation=matrx",
       {"orientation cannot be 'matrx'", "did you mean 'matrix'", "matrix, quaternion",
        "default: quaternion; stock: matrix"}},
      {"ode,iterations=0", {"iterations cannot be '0'", "whole number from 1 to 1000", "default: 20"}},
      {"ode,iterations=2.5", {"iterations cannot be '2.5'"}},
      {"ode,iterations=nan", {"iterations cannot be 'nan'"}},
      {"ode,iterations", {"'iterations' has no value"}},
      {"ode,iterations=1,iterations=2", {"'iterations' is given twice"}},
      {"ode,", {"nothing follows the comma"}},
      {"ode@stok", {"no track 'stok'", "did you mean 'stock'", "matched, stock"}},
      {"ode@", {"no track ''"}},
  };
  for (const auto& [text, fragments] : rows) {
    const std::string error = error_of(text);
    for (const char* fragment : fragments) {
      BOOST_TEST(error.find(fragment) != std::string::npos,
                 "'" << text << "' gave: " << error << "; wanted: " << fragment);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
