#include "cases/case/case_reader.h"

#include <boost/test/unit_test.hpp>

#include "adapters/engines.h"
#include "cases/case/suite.h"
#include "cases/metrics/metric.h"
#include "cases/truth/truth.h"
#include "tests/cases/vocabulary.h"
#include "tests/core/scene/toml/refusal.h"
#include "tests/folder.h"

using namespace rigor;

namespace cases_case_case_reader {

// Lines 1 to 7; what a row adds begins on line 8.
const std::string kStart = R"(title = "A test"
[scene]
body = [{ name = "cube", mass = 1, inertia = [1, 1, 1] }]
[run]
duration = 2
dt = ["1/30", 0.01, 1]

)";

const std::vector<Refusal> kBadCases = {
    {"", "1:1: title: missing", {}},
    {"titel = 'x'", "1:1: titel: unknown key", {"did you mean 'title'?", "title, source, scene, run, truth, gate"}},
    {"title = ''", "1:9: title: ", {"empty string"}},
    {"title = 'x'", "1:1: scene: missing", {}},
    {"title = 'x'\nsource = 1", "2:10: source: ", {"found 1", "a string"}},
    {"title = 'x'\nscene.body = [{ name = 'a', fixed = true }]", "1:1: run: missing", {}},
    {"title = 'x'\nscene.body = [{ name = 'a', fixed = true }]\n[run]\ndt = 1", "3:1: run.duration: missing", {}},
    {"title = 'x'\nscene.body = [{ name = 'a', fixed = true }]\n[run]\nduration = 1", "3:1: run.dt: missing", {}},
};

const std::vector<Refusal> kBadRuns = {
    {"duration = 0\ndt = 1", "4:12: run.duration: ", {"found 0", "greater than 0"}},
    {"duration = -1\ndt = 1", "4:12: run.duration: ", {"found -1"}},
    {"duration = nan\ndt = 1", "4:12: run.duration: ", {"found nan"}},
    {"duration = inf\ndt = 1", "4:12: run.duration: ", {"found inf"}},
    {"duration = 'long'\ndt = 1", "4:12: run.duration: ", {"found 'long'"}},
    {"duration = true\ndt = 1", "4:12: run.duration: ", {"found a boolean"}},
    {"duration = 1\ndt = 0.1\nensemble = 3", "6:12: run.ensemble: ", {"found 3", "from 16 to 10000"}},
    {"duration = 1\ndt = 0.1\nensemble = 20.5", "6:12: run.ensemble: ", {"found 20.5", "whole number"}},
    {"duration = 1\ndt = 0", "5:6: run.dt: ", {"found 0"}},
    {"duration = 1\ndt = -1", "5:6: run.dt: ", {"found -1"}},
    {"duration = 1\ndt = nan", "5:6: run.dt: ", {"found nan"}},
    {"duration = 1\ndt = '1/0'", "5:6: run.dt: ", {"found '1/0'", "as 1/30"}},
    {"duration = 1\ndt = ['1/30', '-1/30']", "5:15: run.dt[1]: ", {"found '-1/30'"}},
    {"duration = 1\ndt = []", "5:6: run.dt: ", {"empty array"}},
    {"duration = 1\ndt = [[1]]", "5:7: run.dt[0]: ", {"found an array"}},
    {"duration = 1\ndt = 1e300", "5:6: run.dt: ", {"a step of 1e+300 s, longer than the run", "at most 1 s"}},
    {"duration = 1\ndt = 1e-300", "5:6: run.dt: ", {"at most 1e+12 steps"}},
    {"duration = 1\ndt = [0.5, '1/2']", "5:12: run.dt[1]: ", {"given twice"}},
    {"duration = 1\ndt = 1\nstep = 1", "6:1: run.step: unknown key", {"duration, dt"}},
};

// Each begins on line 8, below kStart.
const std::vector<Refusal> kBadJudgements = {
    {"[truth]", "8:1: truth.kind: missing", {}},
    {"[truth]\nkind = 'referense'", "9:8: truth.kind: ", {"found 'referense'", "did you mean 'reference'?", "none"}},
    {"[truth]\nkin = 'none'", "9:1: truth.kin: unknown key", {"'kind'"}},
    {"[gate]\nmetric = 'position_error'", "8:1: gate: ", {"found a table", "[[gate]]"}},
    {"[[gate]]\nmax = 1\nbecause = 'x'", "8:1: gate.metric: missing", {}},
    {"[[gate]]\nmetric = 'positon_error'\nmax = 1\nbecause = 'x'",
     "9:10: gate.metric: ",
     {"found 'positon_error'", "'position_error'", "energy_drift"}},
    {"[[gate]]\nmetric = 'energy_drift'\nmax = 1", "8:1: gate.because: missing", {}},
    {"[[gate]]\nmetric = 'energy_drift'\nmax = 1\nbecause = ''", "11:11: gate.because: ", {"empty string"}},
    {"[[gate]]\nmetric = 'energy_drift'\nbecause = 'x'",
     "8:1: gate: found no bound",
     {"max, min, equals, at_least_order"}},
    {"[[gate]]\nmetric = 'energy_drift'\nmaxx = 1\nbecause = 'x'", "10:1: gate.maxx: unknown key", {"'max'"}},
    {"[[gate]]\nmetric = 'energy_drift'\nmax = '1'\nbecause = 'x'", "10:7: gate.max: ", {"found a string"}},
    {"[[gate]]\nmetric = 'energy_drift'\nmin = nan\nbecause = 'x'", "10:7: gate.min: ", {"found nan"}},
    {"[[gate]]\nmetric = 'energy_drift'\nmin = 2\nmax = 1\nbecause = 'x'",
     "10:7: gate.min: ",
     {"found 2, more than max, 1"}},
    {"[[gate]]\nmetric = 'energy_drift'\nequals = 2\nmax = 1\nbecause = 'x'", "8:1: gate: ", {"do not go together"}},
    {"[[gate]]\nmetric = 'energy_drift'\nat_least_order = 0\nbecause = 'x'",
     "10:18: gate.at_least_order: ",
     {"found 0"}},
    {"[[gate]]\nmetric = 'energy_drift'\ndt = 0.01\nat_least_order = 1\nbecause = 'x'",
     "11:18: gate.at_least_order: ",
     {"two step sizes"}},
    {"[[gate]]\nmetric = 'energy_drift'\ndt = ['1/30', '1/60']\nmax = 1\nbecause = 'x'",
     "10:15: gate.dt[1]: ",
     {"no step 1/60 s", "1/30, 0.01, 1"}},
    {"[[gate]]\nmetric = 'energy_drift'\nengines = ['core:rk5']\nmax = 1\nbecause = 'x'",
     "10:12: gate.engines[0]: ",
     {"'rk5'", "did you mean 'rk4'?"}},
    {"[[gate]]\nmetric = 'energy_drift'\nengines = 'bulet'\nmax = 1\nbecause = 'x'",
     "10:11: gate.engines: ",
     {"'bulet'", "did you mean 'bullet'?"}},
    {"[[gate]]\nmetric = 'energy_drift'\nengines = ['ode@stok']\nmax = 1\nbecause = 'x'",
     "10:12: gate.engines[0]: ",
     {"'stock'"}},
    {"[[gate]]\nmetric = 'energy_drift'\nengines = []\nmax = 1\nbecause = 'x'",
     "10:11: gate.engines: ",
     {"empty array"}},
};

}  // namespace cases_case_case_reader

BOOST_FIXTURE_TEST_SUITE(cases_case_case_reader, Folder)

BOOST_AUTO_TEST_CASE(each_case_that_cannot_be_is_refused) {
  const auto check = [&](const Refusal& row, const std::string& before) {
    const std::string file = write("case.toml", before + row.text);
    check_refusal(row, file, [&] { read_case(file, "x", test::words()); });
  };
  for (const Refusal& row : kBadCases) check(row, "");
  for (const Refusal& row : kBadRuns) check(row, "title = 'x'\nscene.body = [{ name = 'a', fixed = true }]\n[run]\n");
  for (const Refusal& row : kBadJudgements) check(row, kStart);
}

// The code that makes the truth 'events' agrees with it even if both are wrong.
BOOST_AUTO_TEST_CASE(a_gate_that_holds_a_run_to_itself_is_refused) {
  const std::string start = R"(title = "A test"
scene.body = [{ name = "box", mass = 1, position = [0, 0, 2], shape = { type = "box", size = [1, 1, 1] } },
  { name = "ground", shape = { type = "plane", normal = [0, 0, 1], offset = 0 } }]
[run]
duration = 1
dt = 0.01
[truth]
kind = 'TRUTH'
[[gate]]
metric = 'METRIC'
because = 'x'
)";
  const auto refused = [&](const std::string& truth, const std::string& metric, const std::string& rest) {
    std::string text = start + rest;
    text.replace(text.find("TRUTH"), 5, truth), text.replace(text.find("METRIC"), 6, metric);
    const std::string file = write("case.toml", text);
    const std::string message = refusal_of([&] { read_case(file, "x", test::words()); });
    return message.starts_with(file) ? message.substr(file.size()) : message;
  };
  const std::string itself = "max = 1\nengines = ['ode', 'core:rk4,contact=event']";
  BOOST_TEST(refused("events", "position_error", itself)
                 .starts_with(":13:19: gate.engines[1]: found core:rk4,contact=event, whose own code makes the truth "
                              "'events' that position_error is measured against; allowed: "));
  BOOST_TEST(refused("events", "energy_drift", itself).starts_with(":13:19: "));
  BOOST_TEST(refused("events", "observed_order", itself).starts_with(":13:19: "));
  BOOST_TEST(refused("events", "position_error", "engines = 'ode'\nbetter_than = 'core:rk4,contact=event'")
                 .starts_with(":13:15: gate.better_than: found core:rk4,contact=event"));
  // Without a contact option the core takes `event` for few bodies.
  BOOST_TEST(refused("events", "position_error", "max = 1\nengines = ['core:rk4', 'ode']").starts_with(":13:12: "));
  BOOST_TEST(refused("events", "penetration", itself) == "");
  BOOST_TEST(refused("none", "position_error", itself) == "");
}

BOOST_AUTO_TEST_CASE(an_error_in_the_scene_names_the_file) {
  const std::string file = write("case.toml", "title = 'x'\nscene.body = [{ name = 'a' }]");
  BOOST_TEST(
      refusal_of([&] { read_case(file, "x", test::words()); }).starts_with(file + ":2:15: scene.body.mass: missing"));
}

BOOST_AUTO_TEST_CASE(a_case_is_read_with_all_it_says) {
  const std::string text = kStart + R"([truth]
kind = "reference"
[[gate]]
metric = "position_error"
engines = ["core:rk4", "ode@stock"]
dt = "1/100"
min = 0
max = 0.5
because = "of this"
[[gate]]
metric = "energy_drift"
at_least_order = 2
because = "of that"
[[gate]]
metric = "energy_drift"
engines = "bullet"
equals = -1
because = "why not")";
  const std::string file = write("case.toml", text);
  const Case read = read_case(file, "tests/case", test::words());
  BOOST_TEST(read.id == "tests/case");
  BOOST_TEST(read.title == "A test");
  BOOST_TEST(read.source == "");
  BOOST_TEST(read.text == text);
  BOOST_TEST(read.scene.bodies.at(0).name == "cube");
  BOOST_TEST(read.duration == 2);
  BOOST_TEST(read.dt.size() == 3u);
  BOOST_TEST(read.dt.at(0).seconds == 1.0 / 30);
  BOOST_TEST(read.dt.at(0).text == "1/30");
  BOOST_TEST(read.dt.at(1).text == "0.01");
  BOOST_TEST(read.dt.at(2).text == "1");
  BOOST_TEST(read.truth == "reference");
  BOOST_TEST(read.truth_where == file + ":9:8");
  const Gate &first = read.gates.at(0), &second = read.gates.at(1), &third = read.gates.at(2);
  BOOST_TEST(first.metric == "position_error");
  BOOST_TEST(first.engines.size() == 2u);
  BOOST_TEST(first.engines.at(0) == "core:rk4");
  BOOST_TEST(first.dt.at(0).text == "0.01");  // as the run has it
  BOOST_TEST(first.bound().min.value() == 0);
  BOOST_TEST(first.bound().max.value() == 0.5);
  BOOST_TEST(first.because == "of this");
  BOOST_TEST(first.where == file + ":10:1");
  BOOST_TEST(second.engines.empty());
  BOOST_TEST(second.dt.empty());
  BOOST_TEST(second.order()->at_least == 2);
  BOOST_TEST(third.bound().equals.value() == -1);
  BOOST_TEST(!third.bound().max.has_value());
}

BOOST_AUTO_TEST_CASE(a_case_without_a_truth_has_none) {
  BOOST_TEST(read_case(write("case.toml", kStart), "x", test::words()).truth == "none");
  BOOST_TEST(read_case(write("case.toml", kStart + "[truth]\nkind = 'none'"), "x", test::words()).truth == "none");
}

BOOST_AUTO_TEST_CASE(a_duration_may_be_a_fraction_and_one_step_size_needs_no_array) {
  const Case read =
      read_case(write("case.toml",
                      "title = 'x'\nscene.body = [{ name = 'a', fixed = true }]\n[run]\nduration = '7/2'\ndt = '1/2'"),
                "x", test::words());
  BOOST_TEST(read.duration == 3.5);
  BOOST_TEST(read.dt.at(0).seconds == 0.5);
}

BOOST_AUTO_TEST_CASE(every_metric_and_truth_there_is_can_be_named) {
  for (const MetricRow& metric : metrics()) {
    const std::string gate = "[[gate]]\nmetric = '" + metric.name + "'\nmax = 1\nbecause = 'x'";
    BOOST_TEST(read_case(write("case.toml", kStart + gate), "x", test::words()).gates.at(0).metric == metric.name);
  }
  for (const CrossMetricRow& metric : cross_metrics()) {
    const std::string gate = "[[gate]]\nmetric = '" + metric.name + "'\nbecause = 'x'\n";
    BOOST_TEST(read_case(write("case.toml", kStart + gate + "min = 1"), "x", test::words()).gates.at(0).metric ==
               metric.name);
    const std::string refusal =
        refusal_of([&] { read_case(write("case.toml", kStart + gate + "at_least_order = 1"), "x", test::words()); });
    BOOST_TEST(refusal.find("order") != std::string::npos, refusal);
  }
  for (const TruthRow& truth : truths()) {
    std::string kind = "[truth]\nkind = '" + truth.name + "'";
    if (truth.name == "recording") kind += "\nfile = 'absent.csv'\nposition_noise = 1\norientation_noise = 1";
    BOOST_TEST(read_case(write("case.toml", kStart + kind), "x", test::words()).truth == truth.name);
  }
}

BOOST_AUTO_TEST_CASE(every_method_of_every_engine_can_be_named_in_a_gate) {
  for (const EngineInfo& engine : infos_of(engines())) {
    for (const MethodInfo& method : engine.methods) {
      const std::string name = engine.name + ":" + method.name;
      const std::string gate = "[[gate]]\nmetric = 'energy_drift'\nengines = '" + name + "'\nmax = 1\nbecause = 'x'";
      BOOST_TEST_CONTEXT(name) {
        BOOST_TEST(read_case(write("case.toml", kStart + gate), "x", test::words()).gates.at(0).engines.size() == 1u);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_case_cut_anywhere_is_read_or_refused) {
  const std::string text =
      kStart + "[truth]\nkind = 'reference'\n[[gate]]\nmetric = 'energy_drift'\nmax = 1\nbecause = 'é'";
  int refused = 0;
  for (std::size_t length = 0; length < text.size(); ++length) {
    const std::string file = write("case.toml", text.substr(0, length));
    refused += !refusal_of([&] { read_case(file, "x", test::words()); }).empty();
  }
  BOOST_TEST(refused > 100);  // whatever ends before the run, and every half-finished table after it
}

BOOST_AUTO_TEST_CASE(every_case_of_the_suite_is_read) {
  for (const std::string& id : suite_ids(default_suite_dir())) {
    BOOST_TEST_CONTEXT(id) {
      BOOST_TEST(refusal_of([&] { read_case(default_suite_dir() + "/" + id + ".toml", id, test::words()); }) == "");
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
