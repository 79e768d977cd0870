// A run announces its next steps to a world in another process, records the world's CPU time, and keeps its matrices
// and its reduced order.
#include <boost/test/unit_test.hpp>

#include "cases/runner/ensemble.h"
#include "cases/runner/simulate.h"
#include "cases/runner/stable_step.h"
#include "cases/runner/twin_run.h"
#include "core/engine/engine.h"
#include "tests/cases/judged.h"
#include "tests/cases/scripted_engine.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_remote_run)

namespace {

struct Expected {
  double dt;
  long steps, every;
  bool operator==(const Expected&) const = default;
};

// CPU seconds that its own process spends on a step: where each is looked at, and where they come in one request.
struct Cost {
  double apart = 2, together = 2;
};

class NotedEngine : public test::ScriptedEngine {
 public:
  explicit NotedEngine(test::Script script, Cost cost = {})
      : ScriptedEngine({}), script_(std::move(script)), cost_(cost) {}
  std::unique_ptr<World> load(const Scene& scene, const Settings&) const override {
    return std::make_unique<NotedWorld>(*this, scene);
  }
  mutable std::vector<Expected> expected;
  mutable std::vector<int> steps;  // of each world, one after the other

 private:
  class NotedWorld : public World, public RemoteRuns, public MayReduceOrder {
   public:
    NotedWorld(const NotedEngine& engine, const Scene& scene) : engine_(engine), inner_(engine.script_, scene) {
      engine.steps.push_back(0);
    }
    void step(double dt) override {
      inner_.step(dt), ++steps_, ++engine_.steps.back();
      spent_ += every_ == 1 ? engine_.cost_.apart : engine_.cost_.together;
    }
    void read(Snapshot& out) const override { inner_.read(out); }
    SettingsInForce settings_in_force() const override { return {{"steps", std::to_string(steps_)}}; }
    std::string solver_warning() const override { return inner_.solver_warning(); }
    Capabilities capabilities() override { return {.remote = this, .reduced_order = this}; }
    void expect(double dt, long steps, long every) override {
      every_ = every, engine_.expected.push_back({dt, steps, every});
    }
    double remote_cpu_seconds() const override { return spent_; }
    std::optional<ReducedOrder> reduced_order() const override {
      if (steps_ < 3) return {};
      return ReducedOrder{2, "by " + std::to_string(steps_)};
    }

   private:
    const NotedEngine& engine_;
    test::ScriptedWorld inner_;
    int steps_ = 0;
    long every_ = 1;
    double spent_ = 0;  // s
  };

  test::Script script_;
  Cost cost_;
};

test::Script resting() {
  test::Script script;
  script.play = [](int, MutableBodyColumns bodies) { bodies.set_position(0, Vec3::Zero()); };
  return script;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_world_elsewhere_knows_what_steps_will_come) {
  const Scene scene = test::tumbling_body();
  const NotedEngine engine(resting());
  const Simulation run = simulate(engine, {}, scene, 0.5, 2);
  BOOST_TEST((engine.expected == std::vector<Expected>{{0.5, 4, 1}}));  // each is looked at
  BOOST_TEST(run.steps_per_sample == 1);
  engine.expected.clear();
  Case definition;
  definition.scene = scene, definition.duration = 2, definition.ensemble = 2;
  std::string flaw;
  BOOST_TEST(outcomes_of(engine, {}, definition, 0.5, 1, flaw).has_value());
  BOOST_TEST((engine.expected == std::vector<Expected>{{0.5, 4, 4}, {0.5, 4, 4}}));  // the end alone
  engine.expected.clear();
  largest_stable_dt(engine, {}, scene, 2, 1);
  BOOST_TEST((engine.expected.at(0) == Expected{0.5, 4, 1}));
  // Without a pause at the end alone, and step by step.
  engine.expected.clear();
  Simulation quick = run;
  quick.cpu_seconds = 1e-6;
  timed_again(engine, {}, scene, quick);
  BOOST_TEST((engine.expected.at(0) == Expected{0.5, 4, 4}));
  engine.expected.clear();
  EngineTable table;
  auto twin = std::make_unique<NotedEngine>(resting());
  const NotedEngine& noted = *twin;
  table.add(std::move(twin));
  RunName name;
  name.text = name.engine = "scripted";
  run_twin(table, name, scene, run, 2);
  BOOST_TEST_REQUIRE(noted.expected.size() >= 2u);
  for (const Expected& expected : noted.expected) BOOST_TEST((expected == Expected{0.5, 4, 1}));
}

// For a run of 19 µs per step the first 4 ms are timed again: twice without a pause, 10 µs per step, and twice step by
// step, 12 µs. The 2 µs between them are the cost of polling, not of the steps. All of this is the other world's time;
// the script here takes a fraction of a microsecond.
BOOST_AUTO_TEST_CASE(a_long_runs_first_steps_are_timed_again_in_both_ways) {
  const Scene scene = test::tumbling_body();
  const NotedEngine engine(resting(), {12e-6, 10e-6});
  Simulation run;
  run.trajectory.dt = 0.5;
  run.trajectory.samples = {{0, BodyTable(1)}, {500, BodyTable(1)}};
  run.cpu_seconds = 1000 * 19e-6;
  BOOST_TEST(timed_again(engine, {}, scene, run) == 1000 * 17e-6, boost::test_tools::tolerance(0.05));
  BOOST_TEST_REQUIRE(engine.steps.size() == 4u);
  const long first = engine.steps[0];
  BOOST_TEST((first > 100 && first <= 211), first);  // with what the clock takes in each
  for (std::size_t world = 0; world < 4; ++world) {
    BOOST_TEST(engine.steps[world] == first);
    BOOST_TEST((engine.expected.at(world) == Expected{0.5, first, world < 2 ? first : 1}));
  }
}

BOOST_AUTO_TEST_CASE(what_is_spent_elsewhere_is_of_the_steps) {
  const Simulation run = simulate(NotedEngine(resting()), {}, test::tumbling_body(), 0.5, 2);
  BOOST_TEST(std::abs(run.cpu_seconds - 8) < 0.1);  // 2 s a step; its own steps are microseconds
  BOOST_TEST(
      std::isnan(simulate(NotedEngine(resting()), {}, test::tumbling_body(), 0.5, 2, {.is_timed = false}).cpu_seconds));
}

BOOST_AUTO_TEST_CASE(settings_and_order_are_those_of_the_end) {
  test::Script lost = resting();
  lost.play = [](int step, MutableBodyColumns bodies) {
    bodies.set_position(0, step == 3 ? Vec3(std::nan(""), 0, 0) : Vec3(0, 0, 0));
  };
  const Simulation whole = simulate(NotedEngine(resting()), {}, test::tumbling_body(), 0.5, 2);
  BOOST_TEST((whole.settings == SettingsInForce{{"steps", "4"}}));
  BOOST_TEST((whole.reduced_order == ReducedOrder{2, "by 4"}));
  const Simulation blown_up = simulate(NotedEngine(lost), {}, test::tumbling_body(), 0.5, 2);
  BOOST_TEST((blown_up.settings == SettingsInForce{{"steps", "0"}}));
  BOOST_TEST((blown_up.reduced_order == ReducedOrder{2, "by 3"}));
  BOOST_TEST(blown_up.not_finite.value().time == 1.5);
}

// Nine more numbers a body, where an engine keeps a matrix: any of them may be the first that is none.
BOOST_AUTO_TEST_CASE(the_numbers_of_a_matrix_have_to_be_finite_as_well) {
  BodyTable bodies(2, true);
  for (std::size_t i = 0; i < 2; ++i)
    bodies.columns().set_orientation(i, Quat::Identity()), bodies.columns().set_rotation(i, Mat3::Identity());
  BOOST_TEST(!body_not_finite(bodies.columns()).has_value());
  for (const int column : {0, kRotation - 1, kRotation + 0, kRotation + 8}) {
    for (const int body : {0, 1}) {
      double& number = bodies.columns().column(column)[body];
      const double before = number;
      number = std::nan("");
      BOOST_TEST(body_not_finite(bodies.columns()).value() == body, column);
      number = before;
    }
  }
}

// As far as it is told to, whatever that leaves.
BOOST_AUTO_TEST_CASE(every_so_many_steps_are_kept_and_the_last) {
  const Simulation run = simulate(NotedEngine(resting()), {}, test::tumbling_body(), 0.5, 3.5, {.steps_per_sample = 3});
  BOOST_TEST(run.steps_per_sample == 3);
  std::vector<double> times;
  for (const Sample& sample : run.trajectory.samples) times.push_back(sample.time);
  BOOST_TEST((times == std::vector<double>{0, 1.5, 3, 3.5}));
}

BOOST_AUTO_TEST_SUITE_END()
