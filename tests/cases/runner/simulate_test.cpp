#include "cases/runner/simulate.h"

#include <boost/test/unit_test.hpp>
#include <ctime>
#include <thread>

#include "core/dynamics/model/system.h"
#include "core/engine/engine.h"
#include "core/engine/engine_failure.h"
#include "tests/cases/judged.h"
#include "tests/cases/scripted_engine.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_simulate)

namespace {

// A world that notes the steps of which what its joints carry is to be reported.
class SparedWorld : public test::ScriptedWorld, public ReportsReactions {
 public:
  SparedWorld(const test::Script& script, const Scene& scene, std::vector<int>& reported)
      : ScriptedWorld(script, scene), reported_(reported) {}
  void step(double dt) override {
    ScriptedWorld::step(dt);
    ++steps_;
    if (are_read_) reported_.push_back(steps_);
  }
  Capabilities capabilities() override { return {.reactions = this}; }
  void ask_for_reactions() override {}
  void report_reactions(bool are_read) override { are_read_ = are_read; }
  std::vector<ReportedReaction> reactions() const override { return {{0, Vec3::Constant(steps_), Vec3::Zero()}}; }

 private:
  std::vector<int>& reported_;
  int steps_ = 0;
  bool are_read_ = true;
};

class SparedEngine : public test::ScriptedEngine {
 public:
  SparedEngine() : ScriptedEngine({}) {}
  std::unique_ptr<World> load(const Scene& scene, const Settings&) const override {
    return std::make_unique<SparedWorld>(script_, scene, reported);
  }
  mutable std::vector<int> reported;

 private:
  test::Script script_;
};

}  // namespace

BOOST_AUTO_TEST_CASE(as_many_steps_are_taken_as_fit) {
  struct Row {
    double duration, dt;
    long steps;
  };
  for (const Row& row : {Row{1, 0.1, 10},
                         {10, 1.0 / 30, 300},
                         {1, 0.3, 3},
                         {0.3, 0.1, 3},
                         {0.7, 0.1, 7},
                         {0.05, 0.1, 0},
                         {2, 2, 1},
                         {1, 1.0 / 990, 990}}) {
    BOOST_TEST_CONTEXT(row.duration << " s by " << row.dt) BOOST_TEST(steps_in(row.duration, row.dt) == row.steps);
  }
  BOOST_TEST(steps_in(1, 1e-300) > 1'000'000'000'000'000'000);
}

BOOST_AUTO_TEST_CASE(every_step_is_recorded_from_the_start_on) {
  const Scene scene = test::tumbling_body();
  const Simulation run = simulate(test::ScriptedEngine({}), {}, scene, 0.1, 1);
  BOOST_TEST(run.trajectory.dt == 0.1);
  BOOST_REQUIRE(run.trajectory.samples.size() == 11);
  for (int n = 0; n <= 10; ++n) {
    BOOST_TEST(run.trajectory.samples[n].time == n * 0.1);
    BOOST_TEST(run.trajectory.samples[n].bodies.columns().position(0).x() == n);
  }
  BOOST_TEST((run.settings == SettingsInForce{{"scripted", "yes"}}));
  BOOST_TEST(!run.not_finite.has_value());
  BOOST_TEST(run.solver_warning.empty());
}

// Which is no rotation, and no angle away from any.
BOOST_AUTO_TEST_CASE(a_quaternion_of_no_length_makes_a_run_invalid) {
  Scene scene = test::tumbling_body();
  scene.bodies.push_back(scene.bodies[0]);
  test::Script script;
  script.play = [&](int step, MutableBodyColumns bodies) {
    if (step == 4) bodies.set_orientation(1, Quat(0, 0, 0, 0));
  };
  BOOST_CHECK_EXCEPTION(
      simulate(test::ScriptedEngine(script), {}, scene, 0.5, 10), EngineFailure, [&](const EngineFailure& failure) {
        return failure.kind() == FailureKind::invalid &&
               std::string(failure.what()).starts_with("at 2 s the orientation of '" + scene.bodies[1].name);
      });
}

BOOST_AUTO_TEST_CASE(a_run_ends_before_the_first_number_that_is_not_finite) {
  Scene scene = test::tumbling_body();
  scene.bodies.push_back(scene.bodies[0]);
  for (const double bad : {std::nan(""), -std::numeric_limits<double>::infinity()}) {
    for (const int column : {0, 6, 12}) {
      test::Script script;
      script.play = [&](int step, MutableBodyColumns bodies) {
        if (step >= 4) bodies.column(column)[1] = bad;
      };
      const Simulation run = simulate(test::ScriptedEngine(script), {}, scene, 0.5, 10);
      BOOST_TEST(run.trajectory.samples.size() == 4);
      BOOST_REQUIRE(run.not_finite.has_value());
      BOOST_TEST(run.not_finite->time == 2);
      BOOST_TEST(run.not_finite->body == 1);
    }
  }
}

BOOST_AUTO_TEST_CASE(the_first_solver_warning_is_kept_with_its_time) {
  test::Script script;
  script.solver_warning = [](int step) { return step < 3 ? "" : "gave up in step " + std::to_string(step); };
  const Simulation run = simulate(test::ScriptedEngine(script), {}, test::tumbling_body(), 0.5, 10);
  BOOST_TEST(run.solver_warning == "gave up in step 3");
  BOOST_TEST(run.solver_warning_time == 1.5);
  BOOST_TEST(run.trajectory.samples.size() == 21);
}

BOOST_AUTO_TEST_CASE(a_run_too_long_to_keep_is_thinned_and_keeps_its_end) {
  // 2000 bodies are 208 kB a sample: 3001 of them would pass the limit, every second one does not.
  Scene scene;
  scene.bodies.assign(2000, test::body("b", 1, {1, 1, 1}));
  const Simulation run = simulate(test::ScriptedEngine({}), {}, scene, 0.25, 0.25 * 3001);
  const auto& samples = run.trajectory.samples;
  const double bytes = static_cast<double>(samples.size()) * 2000 * 13 * sizeof(double);
  BOOST_TEST(bytes <= kLargestTrajectory);
  BOOST_TEST(bytes > 0.4 * kLargestTrajectory);
  BOOST_TEST(samples[1].time == 0.5);
  BOOST_TEST(samples.back().time == 0.25 * 3001);
}

// Computed from the bytes of a sample: the largest number of steps that are all kept, and one more. The run itself ends
// at its first step.
BOOST_AUTO_TEST_CASE(every_step_is_kept_as_long_as_all_of_them_fit) {
  test::Script script;
  script.play = [](int step, MutableBodyColumns bodies) { bodies.column(0)[0] = step > 0 ? std::nan("") : 0; };
  Scene scene;
  scene.bodies.assign(100, test::body("b", 1, {1, 1, 1}));
  for (const std::size_t joints : {0, 40}) {
    scene.joints.assign(joints, {.a = kWorld, .b = 0, .type = BallJoint{Vec3::Zero()}});
    const double bytes = sizeof(Sample) + sizeof(double) * (100 + 7) * 13 + sizeof(ReportedReaction) * joints;
    const auto most = static_cast<long>(kLargestTrajectory / bytes);
    const auto every = [&](long steps) {
      return simulate(test::ScriptedEngine(script), {}, scene, 0.25, 0.25 * static_cast<double>(steps))
          .steps_per_sample;
    };
    BOOST_TEST(every(most) == 1);
    BOOST_TEST(every(most + 1) == 2);
    BOOST_TEST(every(2 * most + 2) == 3);
  }
}

BOOST_AUTO_TEST_CASE(the_steps_alone_are_timed) {
  test::Script script;
  volatile double sink = 0;
  script.play = [&](int, MutableBodyColumns) {
    for (int i = 0; i < 100'000; ++i) sink = sink + 1;
  };
  const Scene scene = test::tumbling_body();
  BOOST_TEST(simulate(test::ScriptedEngine(script), {}, scene, 0.1, 10).cpu_seconds > 1e-4);
  // A hundred empty steps take microseconds.
  BOOST_TEST(simulate(test::ScriptedEngine({}), {}, scene, 0.1, 10).cpu_seconds < 1e-3);
}

// The CPU time of the world's other threads counts, too, also if the stepping thread only waits for them.
BOOST_AUTO_TEST_CASE(the_time_of_every_thread_is_counted) {
  double spent = 0;  // s, of the other thread
  test::Script script;
  script.play = [&](int step, MutableBodyColumns) {
    if (step == 0) return;
    std::thread([&] {
      timespec now{};
      volatile double sink = 0;
      for (int i = 0; i < 1'000'000; ++i) sink = sink + 1;
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
      spent += static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
    }).join();
  };
  const double counted = simulate(test::ScriptedEngine(script), {}, test::tumbling_body(), 0.1, 1).cpu_seconds;
  BOOST_TEST(spent > 1e-3);
  BOOST_TEST(counted >= 0.99 * spent);  // the clock's readings, microseconds a step, are taken off
  BOOST_TEST(counted < 1.4 * spent);    // what beginning and ending a thread takes is a few per cent
}

BOOST_AUTO_TEST_CASE(reactions_are_asked_for_where_they_are_read_and_nowhere_else) {
  const SparedEngine engine;
  const Simulation run = simulate(engine, {}, test::tumbling_body(), 0.1, 1, {.reactions_every = 3});
  BOOST_TEST((engine.reported == std::vector<int>{2, 5, 8}));
  for (std::size_t n = 0; n < run.trajectory.samples.size(); ++n) {
    const auto& reactions = run.trajectory.samples[n].reactions;
    BOOST_REQUIRE_EQUAL(reactions.size(), n == 2 || n == 5 || n == 8 ? 1u : 0u);
    if (!reactions.empty()) BOOST_TEST(reactions[0].force.x() == static_cast<double>(n));
  }
  engine.reported.clear();
  simulate(engine, {}, test::tumbling_body(), 0.1, 0.5, {.reactions_every = 1});
  BOOST_TEST((engine.reported == std::vector<int>{2, 3, 4, 5}));
  engine.reported.clear();
  for (const Sample& sample : simulate(engine, {}, test::tumbling_body(), 0.1, 1).trajectory.samples)
    BOOST_TEST(sample.reactions.empty());
  BOOST_TEST(engine.reported.empty());
}

BOOST_AUTO_TEST_CASE(short_steps_are_timed_again_without_a_pause_and_long_ones_are_not) {
  int steps = 0;
  bool is_long = false;
  volatile double sink = 0;
  test::Script script;
  script.play = [&](int step, MutableBodyColumns) {
    steps += step > 0;
    for (int i = 0; is_long && i < 200'000; ++i) sink = sink + 1;  // far over the 20 us of a long step
  };
  const test::ScriptedEngine engine(script);
  const Scene scene = test::tumbling_body();
  const Simulation quick = simulate(engine, {}, scene, 0.1, 10);
  steps = 0;
  const double again = timed_again(engine, {}, scene, quick);
  BOOST_TEST(again > 0);
  BOOST_TEST(steps % 100 == 0);
  BOOST_TEST(steps >= 300);  // 100 steps of nothing are repeated, up to a hundred times
  BOOST_TEST(again < 100 * 20e-6);

  // Of a run that takes longer only its first milliseconds are, twice in each way.
  const Simulation whole = simulate(engine, {}, scene, 0.1, 100'000);
  steps = 0;
  const double corrected = timed_again(engine, {}, scene, whole);
  BOOST_TEST(corrected > 0);
  BOOST_TEST(corrected <= whole.cpu_seconds);
  BOOST_TEST(steps > 0);
  BOOST_TEST(steps < 500'000);

  is_long = true;
  const Simulation slow = simulate(engine, {}, scene, 0.1, 1);
  steps = 0;
  BOOST_TEST(timed_again(engine, {}, scene, slow) == slow.cpu_seconds);
  BOOST_TEST(steps == 0);
}

// Each of the four by itself: as far off as single precision makes it, and half as far again.
BOOST_AUTO_TEST_CASE(a_run_has_to_start_where_the_scene_says) {
  Scene scene;
  scene.bodies = {test::body("far", 1, {1, 1, 1}, {30, 0, 40}), test::body("ground", 1, {1, 1, 1})};
  scene.bodies[0].velocity = {3, 4, 0}, scene.bodies[0].angular_velocity = {0, 0, 2};
  scene.bodies[1].shape = Plane{Vec3::UnitZ(), 0}, scene.bodies[1].fixed = true;
  const auto fault = [&](std::size_t body, const Vec3& moved, double turned, const Vec3& faster, const Vec3& quicker) {
    BodyTable start(2);
    set_initial_state(scene, start.columns());
    BodyState state = std::as_const(start).columns().body(body);
    state.position += moved, state.velocity += faster, state.angular_velocity += quicker;
    state.orientation = rotation_by({turned, 0, 0}) * state.orientation;
    start.columns().set_body(body, state);
    Simulation run;
    run.trajectory.samples.push_back({0, start});
    try {
      check_start(run, scene);
    } catch (const EngineFailure& failure) {
      return failure.kind() == FailureKind::invalid ? std::string(failure.what()) : "another kind";
    }
    return std::string();
  };
  const Vec3 none = Vec3::Zero(), x(1e-5, 0, 0);  // of the largest: 50 m, 5 m/s, 2 rad/s
  BOOST_TEST(fault(0, 49 * x, 0.98e-5, 4.9 * x, 1.96 * x) == "");
  BOOST_TEST(fault(0, 75 * x, 0, none, none).starts_with("at t = 0 the position of 'far' is 0.00075 m from"));
  BOOST_TEST(fault(0, none, 1.5e-5, none, none).starts_with("at t = 0 the orientation of 'far' is 1.5e-05 rad from"));
  BOOST_TEST(fault(0, none, 0, 7.5 * x, none).starts_with("at t = 0 the velocity of 'far' is 7.5e-05 m/s from"));
  BOOST_TEST(fault(0, none, 0, none, 3 * x).starts_with("at t = 0 the angular velocity of 'far' is 3e-05 rad/s from"));
  BOOST_TEST(fault(1, 1e6 * x, 0.1, none, none) == "");  // where a plane's origin is means nothing
  scene.bodies[1].shape = Sphere{0.5};
  BOOST_TEST(fault(1, 1e6 * x, 0, none, none).starts_with("at t = 0 the position of 'ground' is 10 m from"));
  // If nothing moves, a rounding has no scale.
  scene.bodies.resize(1), scene.bodies[0].shape.reset();
  scene.bodies[0].position = scene.bodies[0].velocity = scene.bodies[0].angular_velocity = none;
  scene.bodies.push_back(scene.bodies[0]);
  BOOST_TEST(fault(0, 0.9e-4 * x, 0, 0.9e-4 * x, 0.9e-4 * x) == "");
  BOOST_TEST(fault(0, 1.2e-4 * x, 0, none, none) != "");
  BOOST_TEST(fault(1, none, 0, 1.2e-4 * x, none) != "");
  BOOST_TEST(fault(1, none, 0, none, 1.2e-4 * x) != "");
  check_start({}, scene);  // of a run without a sample there is nothing to say
}

BOOST_AUTO_TEST_SUITE_END()
