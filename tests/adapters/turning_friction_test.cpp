// Rolling and torsional friction of every engine that declares them, against Newton's law for a ball. A couple of d N
// slows a ball that rolls by g d/(r (1 + k)), and one that spins by g s/(k r²), k = 2/5.
#include <cmath>
#include <set>

#include "core/engine/engine_failure.h"
#include "tests/adapters/seam_runs.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_turning_friction)

namespace {

constexpr double kG = 9.81, kBallRadius = 0.1, kRound = 0.4, kStep = 1.0 / 1000;  // m/s², m, 1, s

Scene ball_on_plane(const ContactLaw& law) {
  Scene scene;
  scene.gravity = {0, 0, -kG};
  scene.bodies = {test::body("ball", 2, kRound * 2 * kBallRadius * kBallRadius * Vec3::Ones(), {0, 0, kBallRadius})};
  scene.bodies[0].shape = Sphere{kBallRadius}, scene.bodies[0].collides = true;
  Body ground;
  ground.name = "ground", ground.shape = Plane{Vec3::UnitZ(), 0}, ground.fixed = ground.collides = true;
  scene.bodies.push_back(ground);
  scene.contact_default = law;
  return scene;
}

Scene rolling_ball(double heading, double length) {
  Scene scene = ball_on_plane({.friction = 0.5, .rolling_friction = length, .torsional_friction = 1e-3});
  const Vec3 way(std::cos(heading), std::sin(heading), 0);
  scene.bodies[0].velocity = way;
  scene.bodies[0].angular_velocity = 1 / kBallRadius * Vec3::UnitZ().cross(way);
  return scene;
}

// MuJoCo has one elliptic cone for sliding and turning friction. The sliding friction that a rolling ball needs takes
// (d/(r (1 + k) mu))²/2 of the couple: 4e-4 here. Its friction is soft, which adds the rest. Others have all of it.
double share_allowed(const Run& run) { return run.info.name == "mujoco" ? 0.02 : 2e-3; }

void check_rolling(const Run& run, double heading) {
  const double length = 0.002, brake = kG * length / (kBallRadius * (1 + kRound)), until = 2;
  const auto world = run.load(rolling_ball(heading, length));
  const BodyTable end = state_after(*world, kStep, static_cast<int>(until / kStep));
  const Vec3 place = end.columns().position(0), v = end.columns().velocity(0);
  BOOST_TEST(std::abs(1 - v.norm() - brake * until) < share_allowed(run) * brake * until);
  BOOST_TEST(std::abs(std::atan2(place.y(), place.x()) - heading) < 1e-3);
}

// The matched runs that declare the feature of the scene, at least so many engines.
void for_each_matched(const Scene& scene, std::size_t least, const std::function<void(const Run&)>& check) {
  std::set<std::string> engines;
  for_each_run(scene, kStep, [&](const Run& run) {
    if (run.settings.track != Track::matched) return;
    engines.insert(run.info.name);
    check(run);
  });
  BOOST_TEST(engines.size() >= least);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_ball_slows_by_the_couple_of_rolling_friction_in_any_direction) {
  for (const double heading : {0.0, 0.5, 0.785}) {
    for_each_matched(rolling_ball(heading, 0.002), 2, [&](const Run& run) {
      BOOST_TEST_CONTEXT("heading " << heading) check_rolling(run, heading);
    });
  }
}

BOOST_AUTO_TEST_CASE(a_ball_slows_by_the_couple_of_torsional_friction) {
  const double length = 0.002, brake = kG * length / (kRound * kBallRadius * kBallRadius), until = 1;
  Scene scene = ball_on_plane({.friction = 0.5, .torsional_friction = length});
  scene.bodies[0].angular_velocity = {0, 0, 20};
  for_each_matched(scene, 2, [&](const Run& run) {
    const auto world = run.load(scene);
    const BodyTable end = state_after(*world, kStep, static_cast<int>(until / kStep));
    const double lost = 20 - end.columns().angular_velocity(0).z();
    BOOST_TEST(std::abs(lost - brake * until) < share_allowed(run) * brake * until);
  });
}

// Without these features a ball rolls and spins for ever, so an engine that ignored them would be wrong in silence.
BOOST_AUTO_TEST_CASE(engines_without_it_say_so_before_they_load) {
  for (const Run& run : all_runs()) {
    const bool has = run.info.features.contains(Feature::rolling_friction);
    BOOST_TEST((has || !run.supports(rolling_ball(0, 0.002), kStep)), run.name());
    BOOST_TEST(has == run.info.features.contains(Feature::torsional_friction), run.name());
  }
}

BOOST_AUTO_TEST_CASE(what_an_engine_cannot_combine_it_refuses) {
  for (const Run& run : all_runs()) {
    const bool is_mujoco = run.info.name == "mujoco", is_ode = run.info.name == "ode";
    const Scene no_torsion = ball_on_plane({.friction = 0.5, .rolling_friction = 0.002});
    if (is_mujoco) BOOST_CHECK_THROW(run.load(no_torsion), EngineFailure);
    const Scene infinite = ball_on_plane({.friction = kInfiniteFriction, .rolling_friction = 0.002});
    if (is_ode) BOOST_CHECK_THROW(run.load(infinite), EngineFailure);
  }
}

BOOST_AUTO_TEST_SUITE_END()
