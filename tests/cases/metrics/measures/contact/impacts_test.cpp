// The impacts found in recorded runs whose every impact is known.
#include "cases/metrics/measures/contact/impacts.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_measures_contact_impacts)

namespace {

constexpr double kDt = 0.01;  // s

// A place and a velocity on a flight that begins at t = 0.
struct Thrown {
  double height, speed;
};
BodyState flying(const Thrown& from, double t, double x = 0) {
  return {{x, 0, from.height + from.speed * t - 5 * t * t}, Quat::Identity(), {0, 0, from.speed - 10 * t}, {0, 0, 0}};
}

// Dropped from 5 m over the ground it hits at 10 m/s after 1 s, and goes on as `after` says of the time since.
using After = std::function<BodyState(double since)>;
BodyState dropped(double t, const After& after, double x = 0) { return t < 1 ? flying({5.5, 0}, t, x) : after(t - 1); }
BodyState lying(double x = 0) { return {{x, 0, 0.5}, Quat::Identity(), Vec3::Zero(), Vec3::Zero()}; }
BodyState leaving_at(double speed, double since, double x = 0) { return flying({0.5, speed}, since, x); }

Scene balls_over_ground(const std::vector<double>& places) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::plane()};
  for (const double x : places)
    scene.bodies.push_back(test::on_its_own("ball " + std::to_string(x), Sphere{0.5}, 2, {x, 0, 5.5}));
  scene.contact_default = {0.6, 0};
  return scene;
}

using Motion = std::function<BodyState(std::size_t body, double t)>;
Trajectory run_of(const Scene& scene, const Motion& motion, int steps) {
  Trajectory run{kDt, {}};
  for (int n = 0; n <= steps; ++n) {
    BodyTable table(scene.bodies.size());
    table.columns().set_orientation(0, Quat::Identity());
    for (std::size_t i = 1; i < scene.bodies.size(); ++i) table.columns().set_body(i, motion(i, n * kDt));
    run.samples.push_back({n * kDt, table});
  }
  return run;
}

std::vector<ImpactSpeeds> only_impacts_of(const Scene& scene, const Trajectory& run) {
  const auto found = impacts_of(scene, run, 0);
  if (found.empty()) return {};
  BOOST_TEST(found.size() == 1);
  BOOST_TEST((found.begin()->first == std::pair{0, 1}));
  return found.begin()->second;
}

// A speed is a difference over 2e-6 s of a gap of metres: 1e-10 of it is left, and the touch is sought by halving.
void check(const ImpactSpeeds& found, double time, double before, double after) {
  BOOST_TEST(std::abs(found.time - time) < 1e-9);
  BOOST_TEST(std::abs(found.before - before) < 1e-7);
  BOOST_TEST(std::abs(found.after - after) < 1e-7);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_bouncing_ball_is_followed_down_to_a_tenth_of_its_fastest_impact) {
  const Scene scene = balls_over_ground({0});
  const auto truth = make_truth("bounce", scene, 4);
  const auto found = only_impacts_of(scene, test::played(*truth, scene, kDt, 400));
  double time = 1, speed = 10;
  BOOST_TEST_REQUIRE(found.size() == 5);  // of 10, 6, 3.6, 2.16, 1.296 m/s; 0.78 is less than a tenth of 10
  for (const ImpactSpeeds& impact : found) {
    check(impact, time, speed, 0.6 * speed);
    speed *= 0.6, time += 2 * speed / 10;
  }
}

BOOST_AUTO_TEST_CASE(an_impact_is_at_the_touch_wherever_in_a_step_it_falls) {
  const Scene scene = balls_over_ground({0});
  for (const double early : {0.0, 0.001, 0.0049, 0.0093}) {
    const Trajectory run = run_of(
        scene, [&](auto, double t) { return dropped(t + early, [](double s) { return leaving_at(6, s); }); }, 150);
    const auto found = only_impacts_of(scene, run);
    BOOST_TEST_REQUIRE(found.size() == 1);
    check(found[0], 1 - early, 10, 6);
  }
}

BOOST_AUTO_TEST_CASE(what_stays_has_no_speed_after_whether_it_leaves_later_or_never) {
  const Scene scene = balls_over_ground({0});
  const Trajectory stays = run_of(
      scene, [](auto, double t) { return dropped(t, [](double) { return lying(); }); }, 200);
  const auto once = only_impacts_of(scene, stays);
  BOOST_TEST_REQUIRE(once.size() == 1);
  check(once[0], 1, 10, 0);
  // Taken up and dropped again from 0.8 m.
  const auto again = [](double since) { return since < 0.5 ? lying() : flying({1.3, 0}, since - 0.5); };
  const Trajectory anew = run_of(
      scene,
      [&](auto, double t) { return dropped(t, [&](double since) { return since < 0.9 ? again(since) : lying(); }); },
      200);
  const auto twice = only_impacts_of(scene, anew);
  BOOST_TEST_REQUIRE(twice.size() == 2);
  check(twice[0], 1, 10, 0);
  check(twice[1], 1.9, 4, 0);
}

// Gravity adds 0.3 m/s within three samples: a slower touch is no impact.
BOOST_AUTO_TEST_CASE(a_touch_no_faster_than_gravity_makes_it_in_three_samples_is_no_impact) {
  const Scene scene = balls_over_ground({0});
  const auto settling = [&](double speed) {
    const double start = speed * speed / 20;  // m, of the fall to that speed
    return only_impacts_of(scene, run_of(
                                      scene,
                                      [&](auto, double t) {
                                        const double fall = speed / 10;
                                        return t < fall ? flying({0.5 + start, 0}, t) : leaving_at(speed, t - fall);
                                      },
                                      static_cast<int>(2.5 * speed / 10 / kDt)));
  };
  BOOST_TEST(settling(0.19).empty());
  BOOST_TEST(settling(0.29).empty());
  BOOST_TEST(settling(0.3).empty());
  const auto found = settling(0.31);
  BOOST_TEST_REQUIRE(found.size() == 1);
  check(found[0], 0.031, 0.31, 0.31);
}

// A ball that falls by semi-implicit steps onto a floor that pushes a fifth of an overlap out in each step. The speeds
// are whole numbers of g h, and of halves of that after each bounce.
Trajectory stepped_bounces(double height, double restitution, double h, double noise, std::mt19937_64& random) {
  Trajectory run{h, {}};
  double z = 0.5 + height, speed = 0;
  std::uniform_real_distribution<double> between(-noise, noise);
  for (int n = 0; n * h <= 3; ++n) {
    BodyTable table(2);
    table.columns().set_orientation(0, Quat::Identity());
    const Vec3 at(0, 0, z + between(random)), velocity(0, 0, speed + between(random));
    table.columns().set_body(1, {at, Quat::Identity(), velocity, Vec3::Zero()});
    run.samples.push_back({n * h, table});
    const double overlap = std::max(0.0, 0.5 - z), before = speed;
    speed -= 10 * h;
    if (overlap > 0) speed = std::max({speed, -restitution * before, 0.0});
    z += speed * h + 0.2 * overlap;
  }
  return run;
}

// The last bounces of these runs have speeds of exactly two and three g h, and samples with none.
BOOST_AUTO_TEST_CASE(roundings_of_a_run_do_not_decide_what_is_an_impact) {
  Scene scene = balls_over_ground({0});
  std::mt19937_64 random(5);
  int impacts = 0;
  for (const double height : {1.0, 0.5, 2.0}) {
    for (const double restitution : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      for (const double h : {1.0 / 32, 1.0 / 30, 1.0 / 64, 1.0 / 240}) {
        const auto exact = only_impacts_of(scene, stepped_bounces(height, restitution, h, 0, random));
        impacts += static_cast<int>(exact.size());
        for (int k = 0; k < 8; ++k) {
          const auto rounded = only_impacts_of(scene, stepped_bounces(height, restitution, h, 1e-15, random));
          BOOST_TEST_REQUIRE(rounded.size() == exact.size(), height << " m, e = " << restitution << ", h = " << h);
          for (std::size_t i = 0; i < exact.size(); ++i) {
            BOOST_TEST(std::abs(rounded[i].before - exact[i].before) < 1e-7);
            BOOST_TEST(std::abs(rounded[i].after - exact[i].after) < 1e-7,
                       height << " m, e = " << restitution << ", h = " << h << ": " << exact[i].after << " or "
                              << rounded[i].after << " m/s");
          }
        }
      }
    }
  }
  BOOST_TEST(impacts > 100);
}

// Near a third body several impulses may add up to one speed. Near means within the motion of two bodies in two
// samples, here four tenths of a metre.
BOOST_AUTO_TEST_CASE(impacts_near_a_third_body_are_left_out) {
  const auto bounces = [](double gap) {
    const double other = 1 + gap;
    const Scene scene = balls_over_ground({0, other});
    const auto at = [&](std::size_t body, double t) {
      const double x = body == 1 ? 0 : other;
      return dropped(
          t, [&](double since) { return leaving_at(6, since, x); }, x);
    };
    return impacts_of(scene, run_of(scene, at, 150), 0).size();
  };
  BOOST_TEST(bounces(0.3) == 0);
  BOOST_TEST(bounces(0.5) == 2);
}

// A third body that comes near only after they have parted again does not undo it, and one that left before neither.
BOOST_AUTO_TEST_CASE(a_third_body_counts_only_while_the_impact_lasts) {
  const Scene scene = balls_over_ground({0, 30});
  const auto passing = [&](double from, double until) {
    const Motion at = [=](std::size_t body, double t) {
      if (body == 1) return dropped(t, [](double since) { return leaving_at(6, since); });
      BodyState other = dropped(t, [](double since) { return leaving_at(6, since); });
      other.position.x() = t > from && t < until ? 1.01 : 30;
      return other;
    };
    return impacts_of(scene, run_of(scene, at, 150), 0).count({0, 1});
  };
  BOOST_TEST(passing(0.5, 0.9) == 1);
  BOOST_TEST(passing(1.1, 1.4) == 1);
  BOOST_TEST(passing(0.985, 0.995) == 0);
  BOOST_TEST(passing(0.995, 1.005) == 0);
}

BOOST_AUTO_TEST_CASE(of_a_body_with_corners_only_the_first_impact_counts) {
  Scene scene = balls_over_ground({0});
  const auto twice = [](auto, double t) {
    return dropped(t, [](double since) { return since < 0.4 ? leaving_at(2, since) : leaving_at(1, since - 0.4); });
  };
  const Trajectory run = run_of(scene, twice, 155);
  BOOST_TEST(only_impacts_of(scene, run).size() == 2);
  scene.bodies[1].shape = Box{{1, 1, 1}};
  const auto found = only_impacts_of(scene, run);
  BOOST_TEST_REQUIRE(found.size() == 1);
  check(found[0], 1, 10, 2);
}

// Two in flight approach each other at both their speeds, and gravity has no part in it; the first may be the one that
// is fixed.
BOOST_AUTO_TEST_CASE(two_balls_in_flight_meet_at_the_difference_of_their_speeds) {
  Scene scene = balls_over_ground({0, 3});
  scene.bodies[0].collides = false;
  const Motion at = [](std::size_t body, double t) {
    const double since = t - 0.5, speed = since < 0 ? 2 : 1;
    BodyState state = flying({20, 0}, t);
    state.position.x() = body == 1 ? 0 : 2 + speed * std::abs(since) - 1, state.velocity.x() = body == 1 ? 0 : speed;
    if (since < 0 && body == 2) state.velocity.x() = -2;
    return state;
  };
  const auto found = impacts_of(scene, run_of(scene, at, 100), 0);
  BOOST_TEST_REQUIRE(found.size() == 1);
  BOOST_TEST((found.begin()->first == std::pair{1, 2}));
  check(found.begin()->second.at(0), 0.5, 2, 1);
}

// Without gravity nothing is too slow to be an impact.
BOOST_AUTO_TEST_CASE(slow_balls_in_space_meet_as_well) {
  Scene scene = balls_over_ground({0, 3});
  scene.gravity.setZero(), scene.bodies[0].collides = false;
  const Motion at = [](std::size_t body, double t) {
    const double since = t - 0.5, speed = since < 0 ? -0.05 : 0.03;
    BodyState state = lying();
    state.position.x() = body == 1 ? 0 : 1 + speed * since, state.velocity.x() = body == 1 ? 0 : speed;
    return state;
  };
  const auto found = impacts_of(scene, run_of(scene, at, 100), 0);
  BOOST_TEST_REQUIRE(found.size() == 1);
  check(found.begin()->second.at(0), 0.5, 0.05, 0.03);
}

// Three centimetres beside the other one, at constant velocity.
BOOST_AUTO_TEST_CASE(a_near_miss_is_no_impact) {
  Scene scene = balls_over_ground({0, 3});
  scene.gravity.setZero(), scene.bodies[0].collides = false;
  for (const double beside : {1.03, 1.0001}) {
    const Motion passing = [=](std::size_t body, double t) {
      BodyState state = lying();
      state.position = body == 1 ? Vec3(0, 0, 0) : Vec3(2 * (t - 0.503), beside, 0);
      state.velocity = body == 1 ? Vec3(0, 0, 0) : Vec3(2, 0, 0);
      return state;
    };
    BOOST_TEST(impacts_of(scene, run_of(scene, passing, 100), 0).empty());
  }
}

// A ball that is deflected at a radius of 1 m from the other's centre, wherever in a step, and whatever passes is seen.
BOOST_AUTO_TEST_CASE(a_glancing_impact_counts_and_flying_through_does_not) {
  Scene scene = balls_over_ground({0, 3});
  scene.gravity.setZero(), scene.bodies[0].collides = false;
  const double beside = 0.9, depth = std::sqrt(1 - beside * beside);  // m; the touch is at (-depth, beside)
  const Vec3 normal(-depth, beside, 0), before(4, 0, 0), after = before - 1.5 * before.dot(normal) * normal;
  for (const bool is_deflected : {true, false}) {
    const Motion passing = [=](std::size_t body, double t) {
      BodyState state = lying();
      const double since = t - 0.503;
      state.position = body == 1 ? Vec3(0, 0, 0) : Vec3(normal + since * (since > 0 && is_deflected ? after : before));
      state.velocity = body == 1 ? Vec3(0, 0, 0) : (since > 0 && is_deflected ? after : before);
      return state;
    };
    const auto found = impacts_of(scene, run_of(scene, passing, 100), 0);
    BOOST_TEST_REQUIRE(found.size() == (is_deflected ? 1 : 0));
    if (is_deflected) check(found.begin()->second.at(0), 0.503, 4 * depth, 2 * depth);
  }
}

BOOST_AUTO_TEST_CASE(a_run_that_is_empty_or_without_contact_has_no_impact) {
  Scene scene = balls_over_ground({0});
  BOOST_TEST(impacts_of(scene, {kDt, {}}, 0).empty());
  scene.bodies[1].collides = false;
  const Trajectory run = run_of(
      scene, [](auto, double t) { return dropped(t, [](double s) { return leaving_at(6, s); }); }, 150);
  BOOST_TEST(impacts_of(scene, run, 0).empty());
}

BOOST_AUTO_TEST_SUITE_END()
