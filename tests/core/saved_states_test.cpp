// The core saves all that its next steps depend on: a fresh world, and one that has run on, continue with the same
// bits.
#include <boost/test/unit_test.hpp>
#include <map>
#include <optional>

#include "adapters/engines.h"
#include "core/base/error.h"
#include "core/engine/run_name.h"
#include "core/engine/saved_bytes.h"
#include "tests/core/dynamics/joints/jointed_run.h"
#include "tests/saved_runs.h"
#include "tests/scenes.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_saved_states)

namespace {

const Engine& core() { return engines().find("core"); }

std::unique_ptr<World> core_world(const Scene& scene, const std::string& run) {
  return core().load(scene, parse_run_name(run, engines().infos()).settings);
}

bool is_supported(const Scene& scene, const std::string& run, double dt) {
  const RunName name = parse_run_name(run, engines().infos());
  return why_unsupported(engines().info_of("core"), name.settings, scene, dt).empty();
}

void check_restored(const Scene& scene, const std::string& run, double dt, long steps, long every) {
  BOOST_TEST_CONTEXT(run) {
    const auto world = core_world(scene, run), fresh = core_world(scene, run);
    const SavedRun saved = saved_run(*world, dt, steps, every);
    BOOST_TEST(restored_apart(*fresh, saved) == "");
    BOOST_TEST(restored_apart(*world, saved) == "");
  }
}

// Tests of bad states.
std::string why_refused(World& world, const SavedState& state) {
  try {
    world.capabilities().state->restore(state);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_integrator_continues_with_the_same_bits) {
  int checked = 0;
  for (const MethodInfo& method : engines().info_of("core").methods) {
    for (const Scene& scene : {coupled_bodies(0.2), tumbling_body(), suite_scene("springs/strong-damping")}) {
      const std::string run = "core:" + method.name;
      if (!is_supported(scene, run, 0.01)) continue;
      check_restored(scene, run, 0.01, 40, 5);
      ++checked;
    }
  }
  BOOST_TEST(checked > 50);
}

BOOST_AUTO_TEST_CASE(joints_limits_motors_and_servos_continue_with_the_same_bits) {
  int checked = 0;
  for (const char* id : {"joints/chain-10", "joints/compound-root", "joints/motor-to-limit", "joints/pendulum-at-stop",
                         "drives/friction-slider", "drives/sampled-pd", "drives/servo-saturated", "mechanisms/four-bar",
                         "mechanisms/slider-crank-singular", "transmissions/armature-pendulum"}) {
    for (const MethodInfo& method : engines().info_of("core").methods) {
      const Scene scene = suite_scene(id);
      const std::string run = "core:" + method.name;
      if (!is_supported(scene, run, 1.0 / 30)) continue;
      BOOST_TEST_CONTEXT(id) check_restored(scene, run, 1.0 / 30, 45, 15);
      ++checked;
    }
  }
  BOOST_TEST(checked > 60);
}

BOOST_AUTO_TEST_CASE(each_contact_method_continues_with_the_same_bits) {
  struct Row {
    const char *id, *method;
    double dt;
    long steps;
  };
  std::map<std::string, int> checked;
  for (const Row& row : std::vector<Row>{{"contact/collision", "course", 0.01, 90},
                                         {"contact/pile-666", "course", 1.0 / 30, 30},
                                         {"contact/bounce-half", "event", 0.01, 90},
                                         {"contact/cradle", "event", 0.01, 60},
                                         {"contact/toppling-box", "event", 0.01, 60},
                                         {"contact/sliding-stop", "event", 0.01, 60},
                                         {"contact/dominoes-three", "event", 0.01, 60},
                                         {"contact/bounce-half", "impulse", 0.01, 90},
                                         {"contact/card-house", "impulse", 0.01, 30},
                                         {"contact/pile-666", "impulse", 1.0 / 30, 30},
                                         {"contact/stack-of-ten", "impulse", 1.0 / 30, 45},
                                         {"rolling-friction/ball-rolls-to-rest", "impulse", 0.01, 60},
                                         {"mechanisms/ragdoll-on-floor", "impulse", 0.01, 60},
                                         {"joints/pendulum-at-wall", "event", 0.01, 90},
                                         {"mechanisms/cradle", "event", 0.01, 45},
                                         {"mechanisms/cradle", "impulse", 0.01, 45},
                                         {"soft-contact/damped-ball", "soft", 0.01, 90}}) {
    const Scene scene = suite_scene(row.id);
    for (const char* integrator : {"velocity-verlet", "semi-implicit-euler", "rk4"}) {
      const std::string run = std::string("core:") + integrator + ",contact=" + row.method;
      if (!is_supported(scene, run, row.dt)) continue;
      BOOST_TEST_CONTEXT(row.id) check_restored(scene, run, row.dt, row.steps, 15);
      ++checked[row.method];
      if (scene.bodies.size() > 100) break;
    }
  }
  for (const char* method : {"course", "event", "impulse", "soft"}) BOOST_TEST(checked[method] > 0, method);
}

// Bodies at rest keep their state, so only the reports show what a restored world has lost.
BOOST_AUTO_TEST_CASE(bodies_at_rest_report_the_same_forces_after_they_are_restored) {
  for (const char* method : {"event", "impulse"}) {
    const auto world =
        core_world(suite_scene("contact/lying-still"), std::string("core:velocity-verlet,contact=") + method);
    ReportsContacts& reports = *world->capabilities().contacts;
    reports.ask_for_contacts();
    const auto sum = [&] {
      Vec3 force = Vec3::Zero();
      for (const ReportedContact& contact : reports.contacts()) force += contact.force;
      return force;
    };
    const auto at_start = world->capabilities().state->save();
    world->step(0.01);
    const Vec3 due = sum();
    BOOST_TEST(due.norm() > 0, method);
    world->step(0.01);
    world->capabilities().state->restore(*at_start);
    world->step(0.01);
    BOOST_TEST((sum() - due).norm() <= 1e-12 * due.norm(), method);
  }
}

// The same world with the bodies where they are, as a save of their states alone would restore it.
BOOST_AUTO_TEST_CASE(states_of_bodies_alone_are_not_enough) {
  struct Row {
    Scene scene;
    std::string run;
    double dt;
    long steps;
  };
  for (const Row& row : {Row{coupled_bodies(0.2), "core:adams", 0.01, 20},
                         {coupled_bodies(0.2), "core:exponential-adams", 0.01, 20},
                         {suite_scene("contact/stack-of-ten"), "core:velocity-verlet,contact=impulse", 1.0 / 30, 20}}) {
    const auto world = core_world(row.scene, row.run);
    for (long n = 0; n < row.steps; ++n) world->step(row.dt);
    Scene bodies_alone = row.scene;
    const BodyTable now = state_of(*world);
    for (std::size_t i = 0; i < bodies_alone.bodies.size(); ++i) {
      Body& body = bodies_alone.bodies[i];
      if (body.fixed) continue;
      const BodyState state = now.columns().body(i);
      body.position = state.position, body.orientation = state.orientation;
      body.velocity = state.velocity, body.angular_velocity = state.angular_velocity;
    }
    const auto other = core_world(bodies_alone, row.run);
    for (int n = 0; n < 5; ++n) world->step(row.dt), other->step(row.dt);
    BOOST_TEST(bits_apart(state_of(*other).columns(), state_of(*world).columns()) != "", row.run);
  }
}

BOOST_AUTO_TEST_CASE(damaged_states_are_refused_and_change_nothing) {
  const Scene scene = suite_scene("contact/bounce-half");
  const std::string run = "core:velocity-verlet,contact=impulse";
  const auto world = core_world(scene, run), due = core_world(scene, run);
  for (int n = 0; n < 20; ++n) world->step(0.01), due->step(0.01);
  const auto saved = world->capabilities().state->save();
  const std::string bytes = dynamic_cast<const SavedBytes&>(*saved).bytes();
  for (int n = 0; n < 5; ++n) world->step(0.01), due->step(0.01);
  BOOST_TEST(why_refused(*world, SavedBytes("")) == "these bytes are no saved state, or one of another format");
  BOOST_TEST(why_refused(*world, SavedBytes("{\"scene\":1}")) != "");
  for (std::size_t length = 0; length < bytes.size(); ++length)
    BOOST_TEST(why_refused(*world, SavedBytes(bytes.substr(0, length))) != "", length);
  BOOST_TEST(why_refused(*world, SavedBytes(bytes + bytes)) != "");
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    std::string damaged = bytes;
    damaged[k] = static_cast<char>(damaged[k] ^ (1 << k % 8));
    BOOST_TEST(why_refused(*world, SavedBytes(damaged)) != "", k);
  }
  for (int n = 0; n < 10; ++n) world->step(0.01), due->step(0.01);
  BOOST_TEST(bits_apart(state_of(*world).columns(), state_of(*due).columns()) == "");
}

BOOST_AUTO_TEST_CASE(states_of_others_are_refused_with_the_reason) {
  const Scene scene = suite_scene("contact/bounce-half");
  const auto world = core_world(scene, "core:velocity-verlet,contact=impulse");
  const auto refused = [&](const Scene& other_scene, const std::string& run) {
    return why_refused(*world, *core_world(other_scene, run)->capabilities().state->save());
  };
  Scene heavier = scene;
  heavier.bodies[0].mass *= 2;
  BOOST_TEST(refused(scene, "core:velocity-verlet,contact=impulse") == "");
  BOOST_TEST(refused(heavier, "core:velocity-verlet,contact=impulse") ==
             "the saved state is of another scene than this world's");
  BOOST_TEST(refused(scene, "core:rk4,contact=impulse").find("of the method 'rk4,contact=impulse'; this world is of") !=
             std::string::npos);
  struct Foreign : SavedState {};
  BOOST_TEST(why_refused(*world, Foreign()) == "the saved state is one of another kind of engine than core");
  const StateOwner older("core", "0.1", scene, parse_run_name("core:rk4", engines().infos()).settings);
  BOOST_TEST(why_refused(*world, *older.save([](StateArchive&) {})).find("of the version '0.1'") != std::string::npos);
  const StateOwner other("ode", "0.1", scene, {});
  BOOST_TEST(why_refused(*world, *other.save([](StateArchive&) {})) ==
             "the saved state is of the engine 'ode'; this world is of 'core'");
}

// Bytes of another layout, as a later version would write them without a new number.
BOOST_AUTO_TEST_CASE(states_that_are_too_short_or_too_long_are_refused) {
  const Scene scene = suite_scene("contact/bounce-half");
  const auto world = core_world(scene, "core:rk4,contact=impulse");
  for (int n = 0; n < 60; ++n) world->step(0.01);
  const std::string bytes = dynamic_cast<const SavedBytes&>(*world->capabilities().state->save()).bytes();
  const std::string body = bytes.substr(0, bytes.size() - 8);
  const std::string why = "the saved state does not fit this world: one of its lists has another length";
  for (const std::size_t cut : {1, 8, 64, 200})
    BOOST_TEST(why_refused(*world, SavedBytes(with_new_checksum(bytes.substr(0, bytes.size() - cut)))) == why, cut);
  BOOST_TEST(why_refused(*world, SavedBytes(with_new_checksum(body + "x" + std::string(8, '\0')))) == why);
}

BOOST_AUTO_TEST_SUITE_END()
