// Engines against their twins: on smooth scenes an engine must do what its published scheme does, to rounding.
#include <fmt/format.h>

#include <boost/test/unit_test.hpp>

#include "cases/case/suite.h"
#include "cases/metrics/measures/measuring.h"
#include "cases/runner/twin_run.h"
#include "core/dynamics/model/energy.h"
#include "core/dynamics/model/system.h"
#include "core/engine/engine_failure.h"
#include "core/scene/turned.h"
#include "tests/adapters/seam_runs.h"
#include "tests/cases/judged.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_twins)

namespace {

struct SmoothScene {
  const char* name;
  Scene scene;
  double duration;  // s
};

// Unstable about its middle axis: it flips again and again.
Scene asymmetric_top() {
  Scene scene;
  scene.bodies = {test::body("top", 1, {1, 2, 3})};
  scene.bodies[0].angular_velocity = 5 * Vec3(1e-3, 1, 1e-3);
  return scene;
}

// A force and a torque, each for a while that is no whole number of steps.
Scene pushed_body() {
  Body body = moving_body();
  body.inertia = full_inertia();
  Scene scene = scene_of(body, {0, 0, -9.81});
  TimedForce push;
  push.body = 0, push.force = {1, -2, 0.5}, push.torque = {0.2, 0.1, -0.3}, push.point = {0.1, 0.2, -0.1};
  push.from = 0.511, push.until = 2.043;
  scene.forces = {push};
  return scene;
}

// Slow enough, long enough, for Bullet as shipped to put it to sleep while it still swings.
Scene slow_swing() {
  Scene scene;
  scene.bodies = {test::body("ball", 2, {1, 1, 1}, {1.1, 0, 0})};
  scene.springs = {test::spring(kWorld, Vec3::Zero(), 0, Vec3::Zero(), 2, 1)};
  return scene;
}

BodyTable initial_state(const Scene& scene) {
  BodyTable state(scene.bodies.size());
  set_initial_state(scene, state.columns());
  return state;
}

std::vector<SmoothScene> smooth_scenes() {
  return {{"free asymmetric top", asymmetric_top(), 60},
          {"fixed-spring", test::fixed_spring(), 30},
          {"body-springs", test::body_springs(), 30},
          {"coupled bodies of full inertia", test::coupled_bodies(0.5), 10},
          {"free body of full inertia", top(), 10},
          {"timed forces", pushed_body(), 10},
          {"slow swing", slow_swing(), 20}};
}

bool is_built(const std::string& engine) {  // some are where their library is
  const auto& infos = infos_of(engines());
  return std::any_of(infos.begin(), infos.end(), [&](const EngineInfo& info) { return info.name == engine; });
}

// Each engine that has a twin, with every combination of the options that its twin knows, on both tracks.
std::vector<std::string> runs_with_twins() {
  std::vector<std::string> names;
  for (const char* track : {"matched", "stock"}) {
    for (const char* gyroscopic : {"on", "off"}) {
      for (const char* rotation : {"finite", "infinitesimal"}) {
        for (const char* method : {"worldstep", "quickstep"}) {
          names.push_back(std::string("ode:") + method + ",gyroscopic=" + gyroscopic + ",rotation=" + rotation + "@" +
                          track);
        }
      }
    }
    for (const char* gyroscopic : {"implicit-body", "implicit-world", "explicit", "off"}) {
      names.push_back(std::string("bullet,gyroscopic=") + gyroscopic + "@" + track);
    }
    for (const char* engine : {"mujoco", "mujoco3"}) {
      if (!is_built(engine)) continue;
      for (const char* method : {"euler", "implicit", "rk4"})
        names.push_back(fmt::format("{}:{}@{}", engine, method, track));
    }
    if (is_built("dart")) names.push_back(std::string("dart@") + track);
    if (is_built("simbody")) names.push_back(std::string("simbody:semi-explicit-euler@") + track);
    for (const char* engine : {"ode", "ode:quickstep", "bullet"}) names.push_back(std::string(engine) + "@" + track);
  }
  if (is_built("siconos")) {  // as shipped its iteration stops before there are only roundings left
    for (const char* theta : {"", ",theta=0.5", ",theta=0.7", ",theta=1"})
      names.push_back(std::string("siconos") + theta);
  }
  if (is_built("simbody")) {  // as shipped the others choose their own steps
    for (const char* method : {"explicit-euler", "merson", "rk2", "rk3", "verlet"})
      names.push_back(std::string("simbody:") + method);
  }
  return names;
}

struct Unexplained {
  double error, rotation;  // relative to the motion's extent; rad
  double until;            // s, the earlier of the two
};

Unexplained unexplained(const RunName& name, const RunName& twin_name, const Scene& scene, double dt, double duration) {
  const Simulation run = simulate(find_engine(engines(), name.engine), name.settings, scene, dt, duration);
  const TwinRun twin = run_twin(engines(), twin_name, scene, run, duration);
  const JudgedRun judged{scene, run.trajectory, nullptr, 0.5, &twin};
  const Measurement error = *test::measured("unexplained_error", judged).measurement,
                    rotation = *test::measured("unexplained_rotation", judged).measurement;
  // Nothing is compared where the two part at once.
  const double extent = error.series.empty() ? 0 : motion_extents(twin.trajectory)[error.series.size() - 1];
  return {extent > 0 ? error.value / extent : error.value, rotation.value,
          std::min(error.compared_until, rotation.compared_until)};
}

}  // namespace

// Verlet's iteration for the velocities does not converge on these springs at 1/30 s. The result of such a step depends
// on its residual (VerletIntegrator.cpp returns before or after the last projection), and quaternions then stay
// unnormalised. Both runs swing without bounds, and separate.
bool does_not_converge(const std::string& scene, const std::string& run) {
  return scene == "body-springs" && run == "simbody:verlet";
}

// 1e-9 is the need: the comparison ends where the twin's own roundings reach a tenth of it (kRoundingShare).
BOOST_AUTO_TEST_CASE(an_engine_does_what_its_published_scheme_does_to_rounding) {
  for (const SmoothScene& smooth : smooth_scenes()) {
    for (const std::string& text : runs_with_twins()) {
      const RunName name = parse_run_name(text, infos_of(engines()));
      const auto twin = twin_of(engines(), name, smooth.scene);
      BOOST_REQUIRE(twin.has_value());
      const Unexplained found = unexplained(name, *twin, smooth.scene, 1.0 / 30, smooth.duration);
      BOOST_TEST_MESSAGE(smooth.name << ", " << text << ": " << found.error << ", " << found.rotation << " rad until "
                                     << found.until << " s");
      if (does_not_converge(smooth.name, text)) {
        BOOST_TEST(found.error > 0.1, smooth.name << ", " << text << " is explained now: its exception can go");
        continue;
      }
      BOOST_TEST(found.error < 1e-9, smooth.name << ", " << text << ": " << found.error);
      BOOST_TEST(found.rotation < 1e-9, smooth.name << ", " << text << ": " << found.rotation << " rad");
    }
  }
}

// The stock Bullet removes a body from the simulation once it would move 1e6 m in a step
// (btCollisionWorld::updateSingleAabb: "Overflow in AABB"). These two blow up and reach that. On the matched track
// DISABLE_DEACTIVATION prevents it.
bool is_taken_out_by_bullet(const std::string& id, const std::string& run) {
  return run == "bullet@stock" && (id == "springs/stiff-3" || id == "springs/strong-damping");
}

// The need of the suite: nothing of ODE's or Bullet's motion is left unexplained in any smooth case.
BOOST_AUTO_TEST_CASE(in_every_smooth_case_of_the_suite_an_engine_does_what_its_scheme_does) {
  const auto infos = infos_of(engines());
  int compared = 0;
  for (const Case& definition : select_cases({}, default_suite_dir(), test::words())) {
    const Scene& scene = definition.scene;
    const StepSize dt = *std::max_element(definition.dt.begin(), definition.dt.end(),
                                          [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
    std::vector<std::string> runs = {"ode", "ode@stock", "bullet", "bullet@stock"};
    if (is_built("dart")) runs.insert(runs.end(), {"dart", "dart@stock"});
    if (is_built("mujoco")) runs.insert(runs.end(), {"mujoco", "mujoco:implicit", "mujoco:rk4"});
    if (is_built("siconos")) runs.push_back("siconos");
    if (is_built("simbody")) runs.insert(runs.end(), {"simbody", "simbody:semi-explicit-euler"});
    for (const std::string& text : runs) {
      const RunName name = parse_run_name(text, infos);
      const auto twin = twin_of(engines(), name, scene);
      if (!twin || !why_unsupported(find_engine(engines(), name.engine).info(), scene, dt.seconds).empty()) continue;
      Unexplained found;
      try {
        found = unexplained(name, *twin, scene, dt.seconds, definition.duration);
      } catch (const EngineFailure& failure) {  // what only loading a scene shows
        BOOST_TEST((failure.kind() == FailureKind::unsupported), definition.id << ", " << text << failure.what());
        continue;
      }
      ++compared;
      const std::string what = definition.id + ", " + text + " at " + dt.text;
      BOOST_TEST_MESSAGE(what << ": " << found.error << ", " << found.rotation << " rad until " << found.until << " of "
                              << definition.duration << " s");
      if (is_taken_out_by_bullet(definition.id, text)) {
        BOOST_TEST(found.error > 0.1, what << " is explained now: its exception can go");
      } else {
        BOOST_TEST(found.error < 1e-9, what << ": " << found.error);
      }
      // A load a thousand times as heavy as each link: it blows up within ten steps, and roundings with it.
      double most = definition.id == "joints/mass-ratio-chain" && name.engine == "mujoco" ? 2e-9 : 1e-9;
      // DART takes its sines from the C library and the replica from the core, so they round apart in each of 300
      // steps. The flips make 1.7e-7 rad of 1e-12 rad/s at the start, and so up to 2e-10 rad of a rounding of 5 rad/s.
      if (definition.id == "tops/dzhanibekov-box" && name.engine == "dart") most = 5e-9;
      BOOST_TEST(found.rotation < most, what << ": " << found.rotation << " rad");
    }
  }
  BOOST_TEST(compared > 0);
}

// The known figures of both schemes (20.6 % and 76 % of the energy lost in 60 s), and that the twins alone show them.
BOOST_AUTO_TEST_CASE(the_twin_alone_loses_the_energy_that_its_engine_loses) {
  const Scene scene = asymmetric_top();
  const double start = kinetic_energy(scene, initial_state(scene).columns());
  for (const auto& [text, lost] : {std::pair("ode", 0.206), std::pair("bullet", 0.764)}) {
    const RunName name = parse_run_name(text, infos_of(engines())), twin = *twin_of(engines(), name, scene);
    for (const RunName& run : {name, twin}) {
      const Simulation done = simulate(find_engine(engines(), run.engine), run.settings, scene, 1.0 / 30, 60);
      const double end = kinetic_energy(scene, done.trajectory.samples.back().bodies.columns());
      BOOST_TEST(std::abs(1 - end / start - lost) < 0.0005,
                 run.text << " loses " << 1 - end / start);  // last digit given
    }
  }
}

// The comparison with this top ends at 7.7 s (ODE's lasts the 60 s). It starts near a separatrix, where rounding grows,
// and its loss of energy keeps it there. The later difference is still rounding: Bullet in a rotated world separates
// from Bullet as far.
BOOST_AUTO_TEST_CASE(past_the_comparison_an_engine_parts_from_itself_as_far_as_from_its_twin) {
  const Scene scene = asymmetric_top();
  const Quat turn = Quat(0.1, -0.4, 0.3, 0.6).normalized();
  const RunName name = parse_run_name("bullet", infos_of(engines())), twin = *twin_of(engines(), name, scene);
  const auto at = [&](const RunName& run, const Scene& which) {
    return simulate(find_engine(engines(), run.engine), run.settings, which, 1.0 / 30, 60)
        .trajectory.samples.back()
        .bodies.columns()
        .orientation(0);
  };
  const Quat engine = at(name, scene);
  const double from_twin = angle_between(engine, at(twin, scene)),
               from_itself = angle_between(turn * engine, at(name, turned(scene, turn)));
  BOOST_TEST_MESSAGE("from its twin " << from_twin << ", from itself " << from_itself);
  BOOST_TEST(from_twin < 100 * from_itself);  // both are roundings, grown by the same factor
}

BOOST_AUTO_TEST_CASE(a_scene_in_which_bodies_can_touch_has_no_twin_and_nor_has_the_core) {
  const auto infos = infos_of(engines());
  BOOST_TEST(!twin_of(engines(), parse_run_name("ode", infos), test::dropped_sphere(0.5)).has_value());
  BOOST_TEST(!twin_of(engines(), parse_run_name("core:rk4", infos), test::fixed_spring()).has_value());
}

// The metric must see what is not the scheme's: the twin without its gyroscopic term is another scheme.
BOOST_AUTO_TEST_CASE(a_scheme_that_is_not_the_engines_is_seen_at_once) {
  const auto infos = infos_of(engines());
  for (const auto& [engine, other] :
       {std::pair("ode", "core:ode-twin,gyroscopic=off"), std::pair("ode", "core:ode-twin,rotation=infinitesimal"),
        std::pair("bullet", "core:bullet-twin,gyroscopic=explicit"), std::pair("bullet", "core:ode-twin")}) {
    const Unexplained found = unexplained(parse_run_name(engine, infos), parse_run_name(other, infos),
                                          test::coupled_bodies(0.5), 1.0 / 30, 5);
    BOOST_TEST(found.error > 1e-6, engine << " against " << other << ": " << found.error);
    BOOST_TEST(found.rotation > 1e-6, engine << " against " << other << ": " << found.rotation);
  }
}

BOOST_AUTO_TEST_SUITE_END()
