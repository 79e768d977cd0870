// Each engine that saves its state: a fresh world that restores it goes on with the same bits, or the difference is
// known.
#include <boost/test/unit_test.hpp>
#include <set>

#include "core/base/error.h"
#include "tests/adapters/seam_runs.h"
#include "tests/core/dynamics/joints/jointed_run.h"
#include "tests/saved_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(adapters_saved_states)

namespace {

constexpr double kStep = 1.0 / 120;

bool saves(World& world) { return world.capabilities().state != nullptr; }

// A ball between two walls on rails of its own, and boxes on the floor beside it.
Scene boxes_on_floor() {
  Scene scene = suite_scene("contact/tumbling-box");
  return scene;
}

}  // namespace

// Of the built-in engines only Simbody and Siconos do not save.
BOOST_AUTO_TEST_CASE(these_engines_save_their_state) {
  std::set<std::string> saving, all;
  for (const Run& run : all_runs()) {
    if (!run.supports(tumbling_body(), kStep)) continue;
    all.insert(run.info.name);
    if (saves(*run.load(tumbling_body()))) saving.insert(run.info.name);
  }
  for (const std::string& name : all)
    BOOST_TEST(saving.contains(name) == (name != "simbody" && name != "siconos"), name);
}

BOOST_AUTO_TEST_CASE(a_fresh_world_goes_on_with_the_same_bits) {
  for (const char* id : {"contact/bounce-half", "contact/tumbling-box", "joints/pendulum-at-stop", "joints/chain-10",
                         "joints/motor-to-limit", "drives/sampled-pd", "mechanisms/four-bar", "joints/pendulum-at-wall",
                         "mechanisms/ragdoll-on-floor"}) {
    const Scene scene = suite_scene(id);
    for (const Run& run : all_runs()) {
      if (!run.supports(scene, kStep) || run.info.is_in_house) continue;
      const auto world = run.load(scene), fresh = run.load(scene);
      if (!saves(*world)) continue;
      BOOST_TEST_CONTEXT(id << " " << run.name()) {
        const SavedRun saved = saved_run(*world, kStep, 90, 15);
        BOOST_TEST(restored_apart(*fresh, saved) == "");
        BOOST_TEST(restored_apart(*world, saved) == "");
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(states_of_other_engines_and_scenes_are_refused) {
  Scene other = boxes_on_floor();
  other.bodies[0].mass *= 2;
  std::unique_ptr<SavedState> foreign;
  for (const Run& run : all_runs()) {
    if (!run.supports(other, kStep)) continue;
    const auto world = run.load(boxes_on_floor());
    if (!saves(*world)) continue;
    BOOST_TEST_CONTEXT(run.name()) {
      if (foreign) BOOST_CHECK_THROW(world->capabilities().state->restore(*foreign), InputError);
      foreign = run.load(other)->capabilities().state->save();
      BOOST_CHECK_THROW(world->capabilities().state->restore(*foreign), InputError);
    }
  }
  BOOST_TEST(foreign != nullptr);
}

BOOST_AUTO_TEST_SUITE_END()
