#include "cases/runner/stable_step.h"

#include <boost/test/unit_test.hpp>

#include "core/dynamics/model/system.h"
#include "tests/cases/judged.h"
#include "tests/cases/scripted_engine.h"
#include "tests/core/dynamics/joints/jointed_run.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_stable_step)

namespace {
const Engine& core() { return find_engine(engines(), "core"); }

// Stands still, but at steps between two bounds, and counts the steps it takes.
class BandEngine : public test::ScriptedEngine {
 public:
  BandEngine(double from, double to) : ScriptedEngine({}), from_(from), to_(to) {}
  std::unique_ptr<World> load(const Scene& scene, const Settings&) const override {
    return std::make_unique<BandWorld>(*this, scene);
  }
  mutable long steps = 0;

 private:
  class BandWorld : public World {
   public:
    BandWorld(const BandEngine& engine, const Scene& scene) : engine_(engine), bodies_(scene.bodies.size()) {
      set_initial_state(scene, bodies_.columns());
    }
    void step(double dt) override {
      time_ += dt, ++engine_.steps;
      if (dt > engine_.from_ && dt < engine_.to_) bodies_.columns().set_velocity(0, Vec3(1e9, 0, 0));
    }
    void read(Snapshot& out) const override { out.time = time_, out.borrow(bodies_.columns()); }
    SettingsInForce settings_in_force() const override { return {}; }
    std::string solver_warning() const override { return ""; }

   private:
    const BandEngine& engine_;
    BodyTable bodies_;
    double time_ = 0;
  };
  double from_, to_;
};
}  // namespace

BOOST_AUTO_TEST_CASE(the_largest_stable_step_of_an_oscillator_is_the_known_one) {
  // Through the centre of mass, w² = k/m = 400: semi-implicit Euler holds while w dt < 2, so to 0.1 s. Just below it
  // the oscillation is stretched, in energy by 1 / (1 - (w dt / 2)²), which passes tenfold before the limit itself.
  Scene scene;
  scene.bodies = {test::body("bead", 1, {1, 1, 1}, {2, 0, 0})};
  scene.springs = {test::spring(kWorld, {0, 0, 0}, 0, {0, 0, 0}, 400, 0)};
  const double largest = 800;
  const StableStep step = largest_stable_dt(core(), test::core_method("semi-implicit-euler"), scene, 30, largest);
  BOOST_TEST(step.dt < 0.1);
  BOOST_TEST(step.dt > 0.09);
  BOOST_TEST(!step.is_cap);
  BOOST_TEST(!step.is_floor);
}

BOOST_AUTO_TEST_CASE(the_search_says_when_it_ends_at_its_bounds) {
  const Scene scene = test::tumbling_body({1, 1, 1});
  const StableStep free = largest_stable_dt(core(), test::core_method("rk4"), scene, 30, 1);
  BOOST_TEST(free.is_cap);
  BOOST_TEST(free.dt == 0.5);
  test::Script exploding;
  exploding.play = [](int step, MutableBodyColumns bodies) {
    if (step > 0) bodies.set_velocity(0, Vec3(1e9, 0, 0));
  };
  const StableStep none = largest_stable_dt(test::ScriptedEngine(exploding), {}, scene, 30, 1);
  BOOST_TEST(none.is_floor);
  BOOST_TEST(none.dt == 1e-5);
}

// A band that bisection alone skips: 5 % wide, half-way to the limit, as with springs.
BOOST_AUTO_TEST_CASE(a_narrow_band_of_bad_steps_below_the_limit_is_found) {
  const Scene scene = test::tumbling_body({1, 1, 1});
  const BandEngine with_band(0.26, 0.273), without(0.26, 0.26);
  const StableStep found = largest_stable_dt(with_band, {}, scene, 30, 1);
  BOOST_TEST(found.dt <= 0.26);
  BOOST_TEST(found.dt > 0.99 * 0.26);
  BOOST_TEST(!found.is_cap);
  BOOST_TEST(largest_stable_dt(without, {}, scene, 30, 1).is_cap);
  // Two runs, at 0.5 and 0.25 s, and those of 3 % from half of that on: 30 s / 0.5 s x 1.03 / 0.03.
  BOOST_TEST(without.steps > 2000);
  BOOST_TEST(without.steps < 2500);
}

BOOST_AUTO_TEST_CASE(a_search_that_takes_too_much_says_where_it_was_cut) {
  Scene scene = test::tumbling_body({1, 1, 1});
  const StableStep whole = largest_stable_dt(test::ScriptedEngine({}), {}, scene, 30, 1);
  BOOST_TEST(whole.cut == "");
  scene.bodies.resize(5000, scene.bodies[0]);  // 2000 steps are allowed
  const StableStep swept = largest_stable_dt(test::ScriptedEngine({}), {}, scene, 30, 1);
  BOOST_TEST(swept.is_cap);
  BOOST_TEST(swept.dt == 0.5);
  BOOST_TEST(swept.cut.find("by bisection from 0.5 s up") == 0);
  // Blows up in the last of 60 steps and later: no step is found, and the search ends before the smallest.
  test::Script late;
  late.play = [](int step, MutableBodyColumns bodies) {
    if (step >= 60) bodies.set_velocity(0, Vec3(1e9, 0, 0));
  };
  scene.bodies.resize(83333, scene.bodies[0]);  // 120 steps
  const StableStep none = largest_stable_dt(test::ScriptedEngine(late), {}, scene, 30, 1);
  BOOST_TEST(none.is_floor);
  BOOST_TEST(none.dt == 0.125);
  BOOST_TEST(none.cut == "the search's 10 million steps of a body are used up: not searched below 0.125 s");
  scene.bodies.resize(133), scene.joints.resize(129);  // 100 steps
  const StableStep jointed = largest_stable_dt(test::ScriptedEngine(late), {}, scene, 30, 1);
  BOOST_TEST(jointed.is_floor);
  BOOST_TEST(jointed.dt == 0.25);
  BOOST_TEST(jointed.cut == "the search's 0.4 million steps of a body are used up: not searched below 0.25 s");
  scene.joints.resize(200);  // a loop among so many takes a dense system: half a million for one step
  BOOST_TEST(largest_stable_dt(test::ScriptedEngine(late), {}, scene, 30, 1).dt == 0.5);
}

// It reports a failure from the sixtieth step on: no step up to 0.5 s covers 30 s with so few.
BOOST_AUTO_TEST_CASE(a_step_at_which_the_method_fails_is_not_a_stable_one) {
  test::Script failing;
  failing.solver_warning = [](int step) { return std::string(step >= 60 ? "did not converge" : ""); };
  const StableStep none = largest_stable_dt(test::ScriptedEngine(failing), {}, test::tumbling_body({1, 1, 1}), 30, 1);
  BOOST_TEST(none.is_floor);
}

// A chain of rods whips about: the core's adaptive method divides each step as it needs, whatever the step is.
BOOST_AUTO_TEST_CASE(of_jointed_bodies_a_method_that_divides_its_steps_is_asked_once) {
  const Scene scene = test::suite_scene("joints/double-pendulum");
  const StableStep found = largest_stable_dt(core(), test::core_method("dormand-prince"), scene, 2, 100);
  BOOST_TEST(found.is_cap);
  BOOST_TEST(found.dt == 0.5);
  BOOST_TEST(found.cut == "its method divides each step: 0.5 s alone was tried");
  // With next to no energy in play no motion is bounded: it is not called stable for being asked once.
  const StableStep none = largest_stable_dt(core(), test::core_method("dormand-prince"), scene, 0.5, 1e-20);
  BOOST_TEST(!none.is_cap);
  const StableStep free =
      largest_stable_dt(core(), test::core_method("dormand-prince"), test::tumbling_body({1, 1, 1}), 30, 1);
  BOOST_TEST(free.cut == "");  // without joints all steps are tried, as of any method
}

// No clock has a say in it.
BOOST_AUTO_TEST_CASE(a_search_finds_the_same_again) {
  const Scene scene = test::suite_scene("joints/chain-10");
  const StableStep one = largest_stable_dt(core(), test::core_method("explicit-euler"), scene, 30, 100),
                   other = largest_stable_dt(core(), test::core_method("explicit-euler"), scene, 30, 100);
  BOOST_TEST(one.dt == other.dt);
  BOOST_TEST(one.cut == other.cut);
  BOOST_TEST(one.cut.find("CPU time") == std::string::npos);
}

BOOST_AUTO_TEST_CASE(the_course_scenes_have_the_known_stability_limits) {
  struct Row {
    const char* method;
    double fixed_spring, body_springs;
  };
  // Measured independently over 30 s. Near its limit chance decides whether a chaotic run is stable, and other tried
  // steps shift the result by up to a tenth.
  const Row rows[] = {{"explicit-euler", 4.2e-4, 2.2e-4},
                      {"semi-implicit-euler", 0.068, 0.041},
                      {"implicit-midpoint", 0.106, 0.070},
                      {"rk4", 0.126, 0.083}};
  for (const auto& [scene, known] :
       {std::pair{test::fixed_spring(), &Row::fixed_spring}, {test::body_springs(), &Row::body_springs}}) {
    const auto truth = make_truth("reference", scene, 30);
    const double largest = energy_extremes(scene, truth.get(), 30).kinetic;
    for (const Row& row : rows) {
      const double dt = largest_stable_dt(core(), test::core_method(row.method), scene, 30, largest).dt;
      BOOST_TEST_MESSAGE(row.method << ": " << dt << " s, known " << row.*known);
      BOOST_TEST_CONTEXT(row.method) BOOST_TEST(dt == row.*known, boost::test_tools::tolerance(0.1));
    }
  }
}

// A case whose run fails at 1/30 s and not at 1/10, 1/100 and 1/1000 s, and whose search found so much.
StableStep held_to_cells(const StableStep& found, const std::string& failing, bool only_failing = false) {
  CaseResult result;
  result.stable_steps = {{Status::pass, found.cut, found}};
  for (const auto& [text, seconds] : {std::pair{"1/10", 0.1}, {"1/30", 1.0 / 30}, {"1/100", 0.01}, {"1/1000", 0.001}}) {
    Cell cell;
    cell.dt = {seconds, text}, cell.status = Status::pass, cell.metrics["position_error"] = {};
    const bool fails = failing.find(std::string(text) + " ") != std::string::npos;
    if (fails) cell.status = Status::diverged, cell.stability.verdict = Verdict::blown_up;
    if (fails || !only_failing) result.cells.push_back(cell);
  }
  hold_to_cells(result);
  BOOST_TEST(result.stable_steps[0].reason == result.stable_steps[0].step.cut);
  return result.stable_steps[0].step;
}

BOOST_AUTO_TEST_CASE(a_largest_stable_step_is_below_every_step_at_which_the_cases_own_run_fails) {
  const StableStep found{0.125, true, false, "the search's steps are used up"};
  const StableStep held = held_to_cells(found, "1/30 ");
  BOOST_TEST(held.dt == 0.01);
  BOOST_TEST(held.is_cap);
  BOOST_TEST(held.cut == "the case's own run fails at 1/30 s: not searched between that and 1/100 s");
  BOOST_TEST(held_to_cells(found, "1/10 1/100 ").dt == 0.001);
  const StableStep none = held_to_cells(found, "1/30 1/100 ", true);
  BOOST_TEST(none.dt == 0.01);
  BOOST_TEST(none.is_floor);
  // Limits that contradict nothing stay.
  BOOST_TEST(held_to_cells(found, "").dt == 0.125);
  const StableStep finer = held_to_cells({0.03, false, false, ""}, "1/30 1/10 ");
  BOOST_TEST(finer.dt == 0.03);
  BOOST_TEST(finer.cut == "");
  const StableStep floor = held_to_cells({1.0 / 30, false, true, "below"}, "1/30 ");
  BOOST_TEST(floor.is_floor);
  BOOST_TEST(floor.cut == "below");
}

// A ball that an engine without contacts moves through a wall of 1 cm at 1 m/s: no step at which one sees it keeps it
// from there.
BOOST_AUTO_TEST_CASE(a_step_at_which_bodies_pass_through_each_other_is_not_stable) {
  Scene scene = test::tumbling_body({1, 1, 1});
  scene.gravity.setZero();
  Body& ball = scene.bodies[0];
  ball.shape = Sphere{0.1}, ball.collides = true, ball.position = {-5, 0, 0}, ball.velocity = {1, 0, 0};
  scene.bodies.push_back(ball);
  Body& wall = scene.bodies[1];
  wall.name = "wall", wall.shape = Box{{0.01, 3, 3}}, wall.fixed = true;
  wall.position.setZero(), wall.velocity.setZero(), wall.angular_velocity.setZero();
  test::Script script;
  double dt = 0;
  script.play = [&](int step, MutableBodyColumns bodies) {
    bodies.set_position(0, {-5 + step * dt, 0, 0}), bodies.set_velocity(0, {1, 0, 0});
    bodies.set_position(1, {0, 0, 0}), bodies.set_velocity(1, {0, 0, 0});
  };
  dt = 0.5;  // a way a step, whatever the step
  const StableStep through = largest_stable_dt(test::ScriptedEngine(script), {}, scene, 30, 100);
  BOOST_TEST(!through.is_cap);
}

BOOST_AUTO_TEST_SUITE_END()
