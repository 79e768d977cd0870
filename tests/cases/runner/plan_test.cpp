// What a grid is before it runs: its steps, its cells, their files, and what is not searched for.
#include <boost/test/unit_test.hpp>

#include "cases/runner/case_process.h"
#include "cases/runner/grid.h"
#include "core/base/error.h"
#include "core/dynamics/model/system.h"
#include "core/engine/engine_failure.h"
#include "tests/cases/runner/faulty_engine.h"
#include "tests/cases/scripted_engine.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_plan)

namespace {

EngineTable engines_named(const std::vector<std::string>& names) {
  EngineTable table;
  for (const std::string& name : names) table.add(std::make_unique<FaultyEngine>(name, [](double&) {}));
  return table;
}

class ScriptedWithMethod : public test::ScriptedEngine {
 public:
  using ScriptedEngine::ScriptedEngine;
  EngineInfo info() const override {
    EngineInfo info = ScriptedEngine::info();
    info.methods.push_back({"only", "as its script says", 1, false, 0, {}});
    return info;
  }
};

RunName run_named(const std::string& name, const EngineTable& table) { return parse_run_name(name, infos_of(table)); }

Gate gate_on(const std::string& engine) {
  Gate gate;
  gate.metric = "position_error", gate.engines = {engine};
  return gate;
}

}  // namespace

// Of a run of 0.5 s: a step may be all of it, but for a rounding, and there may be 1e9 of them.
BOOST_AUTO_TEST_CASE(the_longest_and_the_shortest_step_of_a_run) {
  const auto is_refused = [](double dt) {
    Case definition = drifting_body("a");
    try {
      override_run(definition, {{{dt, "dt"}}, {}});
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  BOOST_TEST(!is_refused(0.5));
  BOOST_TEST(!is_refused(0.5 * (1 + 0.9e-9)));
  BOOST_TEST(!is_refused(0.5 * (1 + 1e-9)));
  BOOST_TEST(is_refused(0.5 * (1 + 1.2e-9)));
  BOOST_TEST(!is_refused(0.5 / 0.99e9));
  BOOST_TEST(is_refused(0.5 / 1.01e9));
}

BOOST_AUTO_TEST_CASE(a_trajectorys_name_keeps_what_is_plain_and_the_end_of_what_is_long) {
  const EngineTable table = engines_named({"e"});
  const auto name_of = [&](const std::string& id) {
    return plan_grid({drifting_body(id)}, {run_named("e", table)}, table, {false}).cases[0].cells[0].trajectory;
  };
  BOOST_TEST(name_of("azAZ09.-") == "azAZ09.---e--1-10.csv");
  BOOST_TEST(name_of("a/b c_`{@[:") == "a-b_c______--e--1-10.csv");
  const std::string longest = "x" + std::string(78, 'y') + "z";
  BOOST_TEST(name_of(longest) == longest + "--e--1-10.csv");
  BOOST_TEST(name_of("w" + longest) == longest + "--e--1-10.csv");
}

BOOST_AUTO_TEST_CASE(names_that_would_be_the_same_are_numbered) {
  const EngineTable table = engines_named({"e"});
  const Results grid = plan_grid({drifting_body("a b"), drifting_body("a_b"), drifting_body("a?b")},
                                 {run_named("e", table)}, table, {false});
  const char* const expected[] = {"a_b--e--1-10.csv", "a_b--e--1-10--2.csv", "a_b--e--1-10--3.csv"};
  for (int k = 0; k < 3; ++k) BOOST_TEST(grid.cases[k].cells[0].trajectory == expected[k]);
}

BOOST_AUTO_TEST_CASE(a_run_that_only_gates_name_is_planned_where_one_names_it) {
  const EngineTable table = engines_named({"a", "b"});
  std::vector<Case> cases = {drifting_body("without"), drifting_body("with")};
  cases[1].gates = {gate_on("b")};
  const Results grid = plan_grid(cases, {run_named("a", table)}, table, {true}, {run_named("b", table)});
  BOOST_TEST(grid.runs.size() == 2u);
  BOOST_TEST(grid.cases[0].cells.size() == 2u);
  BOOST_TEST(grid.cases[1].cells.size() == 4u);
  BOOST_TEST(grid.cases[0].stable_steps.at(0).reason == "it did not run");
  BOOST_TEST((grid.cases[0].stable_steps.at(1).status == Status::unsupported));
  BOOST_TEST(grid.cases[0].stable_steps.at(1).reason == "not asked for");
  BOOST_TEST(grid.cases[1].stable_steps.at(1).reason == "it did not run");
}

// Of a case without gates all, for nothing would be left of it.
BOOST_AUTO_TEST_CASE(only_what_a_gate_judges_is_planned_where_nothing_else_is_asked_for) {
  const EngineTable table = engines_named({"a", "b"});
  std::vector<Case> cases = {drifting_body("without"), drifting_body("with")};
  cases[1].gates = {gate_on("b")};
  const auto cells_of = [&](bool only_judged) {
    const Results grid = plan_grid(cases, {run_named("a", table), run_named("b", table)}, table, {false, only_judged});
    for (const Cell& cell : grid.cases[1].cells) BOOST_TEST((!only_judged || cell.run == 1));
    return std::pair(grid.cases[0].cells.size(), grid.cases[1].cells.size());
  };
  BOOST_TEST((cells_of(false) == std::pair<std::size_t, std::size_t>(4, 4)));
  BOOST_TEST((cells_of(true) == std::pair<std::size_t, std::size_t>(4, 2)));
}

BOOST_AUTO_TEST_CASE(runs_of_gates_are_named_once_and_only_if_they_are_new) {
  const EngineTable table = engines_named({"a", "b", "c"});
  std::vector<Case> cases = {drifting_body("one"), drifting_body("two")};
  cases[0].gates = {gate_on("a"), gate_on("b")}, cases[1].gates = {gate_on("b"), gate_on("c")};
  const std::vector<RunName> found = runs_of_gates(cases, {run_named("a", table)}, infos_of(table));
  BOOST_TEST_REQUIRE(found.size() == 2u);
  BOOST_TEST(found[0].engine == "b");
  BOOST_TEST(found[1].engine == "c");
}

BOOST_AUTO_TEST_CASE(the_stable_step_is_searched_for_where_it_is_asked_for_and_one_moving_body_may_touch) {
  Case definition = drifting_body("a");
  definition.scene = test::dropped_sphere(1);
  const RunName run = run_named("core:velocity-verlet", engines());
  const auto why_not = [&](bool is_asked) {
    const StableStepResult planned = plan_grid({definition}, {run}, engines(), {is_asked}).cases[0].stable_steps.at(0);
    BOOST_TEST((planned.status == Status::unsupported) == (planned.reason != "it did not run"));
    return planned.reason;
  };
  BOOST_TEST(why_not(true) == "it did not run");
  BOOST_TEST(why_not(false) == "not asked for");
  definition.scene.bodies.push_back(definition.scene.bodies[0]);
  definition.scene.bodies[2].name = "other", definition.scene.bodies[2].position.x() = 3;
  BOOST_TEST(why_not(true) == "not searched for where more than one moving body can touch");
  definition.scene.bodies[2].collides = false;
  BOOST_TEST(why_not(true) == "it did not run");
  definition.scene.bodies[2].collides = definition.scene.bodies[2].fixed = true;
  BOOST_TEST(why_not(true) == "it did not run");
}

// Blown up, warned, both, neither: what a cell says of its run.
BOOST_AUTO_TEST_CASE(a_cell_says_what_became_of_its_run) {
  const Case definition = drifting_body("a");
  const auto cell_of = [&](const FaultyEngine::Fault& fault, const std::string& warning) {
    EngineTable table;
    table.add(std::make_unique<FaultyEngine>("e", fault, warning));
    Cell planned;
    planned.dt = definition.dt[0];
    return run_cell(planned, definition, table, parse_run_name("e", infos_of(table)), nullptr,
                    facts_of(definition, nullptr), {})
        .cell;
  };
  const auto fine = [](double&) {};
  const auto lost = [](double& x) { x = std::nan(""); };
  const Cell good = cell_of(fine, "");
  BOOST_TEST((good.status == Status::pass));
  BOOST_TEST(good.reason == "");
  BOOST_TEST(good.metrics.at("survival").value == 0.5);
  const Cell warned = cell_of(fine, "gave up");
  BOOST_TEST((warned.status == Status::invalid));
  BOOST_TEST(warned.reason == "after 0.1 s the method no longer met its promise: gave up");
  const Cell blown_up = cell_of(lost, "");
  BOOST_TEST((blown_up.status == Status::diverged));
  BOOST_TEST(blown_up.reason == "blown up at 0.10 s: stone; at 0.1 s the state of 'stone' is no longer finite");
  BOOST_TEST(blown_up.metrics.at("survival").value == 0.1);
  const Cell both = cell_of(lost, "gave up");
  BOOST_TEST((both.status == Status::diverged));
  BOOST_TEST(both.reason == blown_up.reason + "; gave up");
}

// Without a truth a run is held to what it keeps, which it does from another start as well.
BOOST_AUTO_TEST_CASE(a_run_without_a_truth_begins_as_the_scene_does) {
  Case definition = drifting_body("a");
  definition.scene.bodies.push_back(definition.scene.bodies[0]);
  Body& other = definition.scene.bodies[1];
  other.name = "other", other.position.x() += 3;
  const auto cell_of = [&](const auto& change, const Truth* truth) {
    test::Script script;
    script.play = [&](int step, MutableBodyColumns bodies) {
      if (step == 0) set_initial_state(definition.scene, bodies), change(bodies);
    };
    EngineTable table;
    table.add(std::make_unique<ScriptedWithMethod>(script));
    Cell planned;
    planned.dt = definition.dt[0];
    return run_cell(planned, definition, table, parse_run_name("scripted", infos_of(table)), truth,
                    facts_of(definition, truth), {})
        .cell;
  };
  const auto as_it_is = [](MutableBodyColumns) {};
  const auto in_other_order = [](MutableBodyColumns bodies) {
    const BodyState first = BodyColumns(bodies).body(0);
    bodies.set_body(0, BodyColumns(bodies).body(1)), bodies.set_body(1, first);
  };
  const auto as_an_invalid = [](const EngineFailure& failure) {
    return failure.kind() == FailureKind::invalid &&
           std::string(failure.what()) == "at t = 0 the position of 'stone' is 3 m from the scene's";
  };
  BOOST_CHECK_NO_THROW(cell_of(as_it_is, nullptr));
  BOOST_CHECK_EXCEPTION(cell_of(in_other_order, nullptr), EngineFailure, as_an_invalid);
  // With one, its errors say so.
  const auto truth = make_truth("reference", definition.scene, definition.duration);
  BOOST_TEST(cell_of(in_other_order, truth.get()).metrics.at("position_error").value >= 3);
  using Change = std::function<void(MutableBodyColumns)>;
  for (const Change& change : {Change([](auto b) { b.set_orientation(1, Quat(std::cos(1e-4), std::sin(1e-4), 0, 0)); }),
                               Change([](auto b) { b.set_velocity(1, Vec3(0, 0, 1e-3)); }),
                               Change([](auto b) { b.set_angular_velocity(1, Vec3(0, 0, 1e-3)); })})
    BOOST_CHECK_THROW(cell_of(change, nullptr), EngineFailure);
  // In single precision.
  BOOST_CHECK_NO_THROW(
      cell_of([](MutableBodyColumns b) { b.column(0)[1] = static_cast<float>(b.column(0)[1]); }, nullptr));
}

// A costly metric is measured where a gate asks for it, a usual one always, and of those asked for by name no others.
BOOST_AUTO_TEST_CASE(what_is_measured_is_what_is_asked_for) {
  const EngineTable table = engines_named({"e"});
  Case definition = drifting_body("a");
  const auto truth = make_truth("reference", definition.scene, 0.5);
  const auto reason_of = [&](const std::string& metric, const GridOptions& options) {
    Cell planned;
    planned.dt = definition.dt[1];
    const Cell cell = run_cell(planned, definition, table, parse_run_name("e", infos_of(table)), truth.get(),
                               facts_of(definition, truth.get()), options)
                          .cell;
    return cell.metrics.at(metric).not_applicable;
  };
  const std::string not_asked = "not measured: no gate asks for it";
  GridOptions plain, only;
  plain.is_thorough = false, only.only_metrics = {"tube"};
  BOOST_TEST(reason_of("tube", plain) == not_asked);
  BOOST_TEST(reason_of("position_error", plain) == "");
  BOOST_TEST(reason_of("tube", only) == "");
  BOOST_TEST(reason_of("position_error", only) == not_asked);
  BOOST_TEST(reason_of("tube", {}) == "");  // thorough
  definition.gates = {gate_on("e")}, definition.gates[0].metric = "tube";
  BOOST_TEST(reason_of("tube", plain) == "");
}

BOOST_AUTO_TEST_SUITE_END()
