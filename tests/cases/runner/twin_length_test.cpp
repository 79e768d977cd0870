// How far a twin and its copies in turned worlds are stepped, counted in steps.
#include "cases/runner/twin_run.h"

#include <boost/test/unit_test.hpp>

#include "tests/cases/runner/faulty_engine.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_twin_length)

namespace {

constexpr long kSteps = 100;

// Moves and rotates its body slightly in each step, along the same axis of any world, so that rotated worlds separate
// by the same amount.
class DriftingEngine : public FaultyEngine {
 public:
  DriftingEngine(double drift, long& steps) : FaultyEngine("drifts", [](double&) {}), drift_(drift), steps_(steps) {}
  std::unique_ptr<World> load(const Scene& scene, const Settings&) const override {
    return std::make_unique<DriftingWorld>(*this, scene.bodies[0]);
  }

 private:
  class DriftingWorld : public World {
   public:
    DriftingWorld(const DriftingEngine& engine, const Body& body)
        : engine_(engine), state_{body.position, body.orientation, Vec3::Zero(), Vec3::Zero()} {}
    void step(double dt) override {
      const Vec3 change(engine_.drift_, 0, 0);
      time_ += dt, ++engine_.steps_;
      state_.position += change, state_.orientation = rotation_by(change) * state_.orientation;
    }
    void read(Snapshot& out) const override { out.time = time_, out.own(1).set_body(0, state_); }
    SettingsInForce settings_in_force() const override { return {}; }
    std::string solver_warning() const override { return ""; }

   private:
    const DriftingEngine& engine_;
    BodyState state_;
    double time_ = 0;
  };

  double drift_;  // m, rad
  long& steps_;
};

struct Found {
  TwinRun twin;
  long steps = 0;  // of all its worlds
};

// Its body is so far from the origin [m].
Found twin_that_drifts(double drift, TwinLength length, double place = 1) {
  Found found;
  EngineTable table;
  table.add(std::make_unique<DriftingEngine>(drift, found.steps));
  Scene scene = drifting_body("a").scene;
  scene.bodies[0].position = Vec3(place, 0, 0);
  Simulation run;
  run.trajectory.dt = 0.01;
  for (long n = 0; n <= kSteps; ++n) run.trajectory.samples.push_back({0.01 * static_cast<double>(n), BodyTable(1)});
  found.twin = run_twin(table, parse_run_name("drifts", infos_of(table)), scene, run, 1, length);
  return found;
}

}  // namespace

// 1e-6 of a metre and a radian is far beyond what a comparison allows: one step of each of the four worlds shows it.
BOOST_AUTO_TEST_CASE(a_twin_is_stepped_no_further_than_it_can_be_compared) {
  const Found found = twin_that_drifts(1e-6, {});
  BOOST_TEST(found.steps <= 2 + 3 + 3);
  BOOST_TEST(found.twin.trajectory.samples.size() == found.twin.position_rounding.size());
  BOOST_TEST(found.twin.position_rounding.back() > 1e-7);
  BOOST_TEST(found.twin.position_rounding.size() <= 3u);
}

BOOST_AUTO_TEST_CASE(a_twin_that_is_measured_itself_is_stepped_to_the_end) {
  const Found found = twin_that_drifts(1e-6, {.is_whole = true});
  BOOST_TEST(found.twin.trajectory.samples.size() == kSteps + 1u);
  BOOST_TEST(found.twin.position_rounding.size() <= 3u);
  BOOST_TEST(found.steps < kSteps + 10);
}

// Roundings of 1e-16 a step come to 1e-14 of a metre, where 1e-10 would end the comparison: one turned world is enough.
BOOST_AUTO_TEST_CASE(where_roundings_are_far_from_mattering_one_turned_world_is_asked) {
  const Found found = twin_that_drifts(3e-16, {});
  BOOST_TEST(found.twin.position_rounding.size() == kSteps + 1u);
  BOOST_TEST(found.twin.position_rounding.back() > 0);
  BOOST_TEST(found.steps == 2 * kSteps);
}

// A thousand times more is still allowed, but so near that each of the three is asked.
BOOST_AUTO_TEST_CASE(where_roundings_might_matter_all_turned_worlds_are_asked) {
  const Found found = twin_that_drifts(3e-13, {});
  BOOST_TEST(found.twin.position_rounding.size() == kSteps + 1u);
  BOOST_TEST(found.steps == 4 * kSteps);
}

// A hundred times as far from the origin places may be off by a hundred times as much, though turns may not.
BOOST_AUTO_TEST_CASE(how_far_a_place_may_be_off_goes_by_how_far_away_it_is) {
  BOOST_TEST(twin_that_drifts(3e-12, {}, 1).twin.position_rounding.size() < kSteps);
  BOOST_TEST(twin_that_drifts(3e-12, {}, 100).twin.position_rounding.size() == kSteps + 1u);
}

BOOST_AUTO_TEST_CASE(a_twin_is_stepped_no_further_than_the_truth_is_good) {
  const Found found = twin_that_drifts(3e-16, {.compared = 11});
  BOOST_TEST(found.twin.trajectory.samples.size() == 11u);
  BOOST_TEST(found.steps == 2 * 10);
}

BOOST_AUTO_TEST_SUITE_END()
