// The closed forms of sliding, rolling, pushing and of impacts on a line, compared with published numbers, and with
// Coulomb's law integrated step by step.
#include <boost/test/unit_test.hpp>

#include <numbers>

#include "core/base/error.h"
#include "core/dynamics/model/energy.h"
#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

using namespace rigor;
using test::truth_at;

BOOST_AUTO_TEST_SUITE(cases_truth_closed_form_contact_contact_forms)

namespace {

const Box kBox{{0.4, 0.4, 0.2}};
const Sphere kBall{0.5};

BodyState state_of(const Scene& scene, const char* truth, double t, std::size_t body = 0) {
  return truth_at(*make_truth(truth, scene, 20), t, scene.bodies.size()).columns().body(body);
}

struct Along {
  double place, speed, spin;  // m, m/s, rad/s down the slope and about its y
};

// A second derivation: Newton and Coulomb by the midpoint rule in tiny steps. Friction is bounded by the force that
// would stop the slip within the step. `k` = I/(m r²); infinite for a body that does not rotate.
Along march(double angle, double friction, Along now, double k, double radius, double until) {
  const double g = 9.81, pull = g * std::sin(angle), most = friction * g * std::cos(angle);
  constexpr int kSteps = 400000;
  const double h = until / kSteps, share = std::isinf(k) ? 1 : k / (1 + k);
  for (int n = 0; n < kSteps; ++n) {
    const double slip = now.speed - (std::isinf(k) ? 0 : radius * now.spin);
    // The force that would end the slip by the end of this step.
    const double wanted = -(slip / h + pull) * share;
    const double brake = std::clamp(wanted, -most, most);
    const double speed = now.speed + h * (pull + brake);
    now.place += h * (now.speed + speed) / 2;
    now.speed = speed;
    if (!std::isinf(k)) now.spin -= h * brake / (k * radius);
  }
  return now;
}

void check_against_march(const Scene& scene, const char* truth, double angle, double friction, double t) {
  const Mat3 R = test::slope_frame(angle);
  const Body& body = scene.bodies[0];
  const bool is_ball = std::holds_alternative<Sphere>(*body.shape);
  const double k = is_ball ? 0.4 : std::numeric_limits<double>::infinity();
  const Along start{0, (R.transpose() * body.velocity).x(), (R.transpose() * body.angular_velocity).y()};
  const Along expected = march(angle, friction, start, k, 0.5, t);
  const BodyState found = state_of(scene, truth, t);
  const Vec3 place = R.transpose() * (found.position - body.position), v = R.transpose() * found.velocity;
  // The marching misses the instants at which the law changes by a step, 400 000 of them in 20 s at up to 100 m/s².
  const double miss = 2e-3;
  BOOST_TEST_CONTEXT(truth << " at " << angle << " rad, mu " << friction << ", t " << t) {
    BOOST_TEST(std::abs(place.x() - expected.place) < miss * std::max(1.0, std::abs(expected.place)));
    BOOST_TEST(std::abs(v.x() - expected.speed) < miss * std::max(1.0, std::abs(expected.speed)));
    BOOST_TEST(std::abs((R.transpose() * found.angular_velocity).y() - expected.spin) < 4 * miss * 10);
    BOOST_TEST(std::abs(place.y()) + std::abs(place.z()) < 1e-12);
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_box_stops_after_the_published_distance) {
  const Scene scene = test::on_slope(kBox, 0, 0.5, 5);
  BOOST_TEST(state_of(scene, "sliding", 2).position.x() == 2.548420, boost::test_tools::tolerance(5e-7 / 2.5));
  BOOST_TEST(state_of(scene, "sliding", 2).position.x() == 25 / (2 * 0.5 * 9.81), boost::test_tools::tolerance(1e-15));
  const double stop = 5 / (0.5 * 9.81);
  BOOST_TEST(state_of(scene, "sliding", stop - 1e-6).velocity.x() > 0);
  BOOST_TEST(state_of(scene, "sliding", stop + 1e-9).velocity.x() == 0);
}

BOOST_AUTO_TEST_CASE(a_box_holds_at_the_threshold_and_slides_below_it) {
  const double angle = std::atan(0.5), g = 9.81;
  BOOST_TEST(state_of(test::on_slope(kBox, angle, 0.5, 0), "sliding", 10).velocity.norm() == 0);
  const Scene slides = test::on_slope(kBox, angle, 0.49, 0);
  const double a = g * (std::sin(angle) - 0.49 * std::cos(angle));
  BOOST_TEST(state_of(slides, "sliding", 10).velocity.norm() == a * 10, boost::test_tools::tolerance(1e-13));
  BOOST_TEST((state_of(slides, "sliding", 10).position - slides.bodies[0].position).norm() == a * 50,
             boost::test_tools::tolerance(1e-13));
}

BOOST_AUTO_TEST_CASE(a_sphere_rolls_from_the_published_instant_at_the_published_speed) {
  const Scene scene = test::on_slope(kBall, 0, 0.3, 10);
  const double rolls = 2 * 10 / (7 * 0.3 * 9.81);
  BOOST_TEST(rolls == 0.970827, boost::test_tools::tolerance(5e-7));
  const BodyState before = state_of(scene, "rolling", 0.970826), after = state_of(scene, "rolling", 0.970828);
  BOOST_TEST(before.velocity.x() - 0.5 * before.angular_velocity.y() > 0);
  BOOST_TEST(std::abs(after.velocity.x() - 0.5 * after.angular_velocity.y()) < 1e-14);
  BOOST_TEST(after.velocity.x() == 7.142857, boost::test_tools::tolerance(5e-8));
}

BOOST_AUTO_TEST_CASE(a_sphere_rolls_down_up_to_three_and_a_half_times_its_friction) {
  const double g = 9.81;
  for (const double slope : {0.1, 1.0, 1.049, 1.051, 2.0}) {
    const double angle = std::atan(slope), mu = 0.3;
    const BodyState after = state_of(test::on_slope(kBall, angle, mu, 0), "rolling", 2);
    const double rolling = 5 * g * std::sin(angle) / 7, slipping = g * (std::sin(angle) - mu * std::cos(angle));
    BOOST_TEST(after.velocity.norm() == 2 * (slope < 3.5 * mu ? rolling : slipping),
               boost::test_tools::tolerance(1e-13));
  }
}

BOOST_AUTO_TEST_CASE(sliding_and_rolling_agree_with_marching_in_small_steps) {
  for (const double angle : {0.0, 0.3, 0.6}) {
    for (const double friction : {0.0, 0.2, 0.5}) {
      for (const double speed : {0.0, 4.0, -4.0}) {
        for (const double t : {0.4, 3.0}) {
          check_against_march(test::on_slope(kBox, angle, friction, speed), "sliding", angle, friction, t);
          for (const double spin : {0.0, 12.0, -12.0})
            check_against_march(test::on_slope(kBall, angle, friction, speed, spin), "rolling", angle, friction, t);
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(the_orientation_follows_the_angular_velocity) {
  const Scene scene = test::on_slope(kBall, 0.6, 0.1, -3, 5);
  const auto truth = make_truth("rolling", scene, 5);
  const double h = 1e-5;
  for (double t = 0.05; t < 4.9; t += 0.31) {
    const BodyState a = truth_at(*truth, t - h, 2).columns().body(0), b = truth_at(*truth, t + h, 2).columns().body(0);
    const BodyState now = truth_at(*truth, t, 2).columns().body(0);
    const Quat turned = b.orientation * a.orientation.conjugate();
    const Vec3 rate = 2 * turned.vec() * (turned.w() < 0 ? -1 : 1) / (2 * h);
    BOOST_TEST((rate - now.angular_velocity).norm() < 1e-5 * (1 + now.angular_velocity.norm()));
    BOOST_TEST(((b.position - a.position) / (2 * h) - now.velocity).norm() < 1e-5 * (1 + now.velocity.norm()));
  }
}

BOOST_AUTO_TEST_CASE(a_ball_laid_on_the_plane_slides_as_one_that_bounces_no_more) {
  const Scene scene = test::on_slope(kBall, 0, 0.3, 10, -7);
  for (const double t : {0.3, 0.9, 1.5, 2.5, 5.0}) {
    const BodyState a = state_of(scene, "rolling", t), b = state_of(scene, "bounce", t);
    BOOST_TEST((a.position - b.position).norm() < 1e-13);
    BOOST_TEST((a.velocity - b.velocity).norm() < 1e-13);
    BOOST_TEST((a.angular_velocity - b.angular_velocity).norm() < 1e-12);
    BOOST_TEST(angle_between(a.orientation, b.orientation) < 1e-12);
  }
}

// With static friction above the friction of sliding, against contact by events.
BOOST_AUTO_TEST_CASE(a_pushed_box_breaks_away_at_its_static_friction) {
  Scene scene = test::pushed_box(0.3);
  scene.bodies.resize(2);  // without the balls
  scene.contact_default.friction = 0.4, scene.contact_default.static_friction = 0.6;
  scene.contact_pairs.clear();
  for (const double share : {0.7, 0.99, 1.01}) {
    const double limit = 0.6 * scene.bodies[1].mass * 9.81;
    scene.forces[0].force *= share * limit / scene.forces[0].force.norm();
    const BodyState pushed = state_of(scene, "pushed", 1, 1), by_events = state_of(scene, "events", 1, 1);
    BOOST_TEST((pushed.position - by_events.position).norm() < 1e-9, share);
    BOOST_TEST((pushed.velocity - by_events.velocity).norm() < 1e-9, share);
    BOOST_TEST(((pushed.velocity.norm() > 0.1) == (share > 1)), share);
  }
}

BOOST_AUTO_TEST_CASE(a_pushed_box_and_its_balls_have_the_published_accelerations) {
  for (const double degrees : {0.0, 45.0, 60.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    const Scene scene = test::pushed_box(angle);
    const auto truth = make_truth("pushed", scene, 2);
    const BodyTable at_one = truth_at(*truth, 1, 27);
    const Vec3 along(std::cos(angle), std::sin(angle), 0);
    BOOST_TEST(at_one.columns().velocity(1).dot(along) == 0.7385, boost::test_tools::tolerance(5e-5 / 0.7));
    BOOST_TEST(at_one.columns().velocity(7).dot(along) == 0.2110, boost::test_tools::tolerance(5e-5 / 0.2));
    // A second derivation: all horizontal momentum comes from the push less the plane's friction, and no ball slips.
    const double pushed = 150 - 0.4 * 35 * 9.81;
    BOOST_TEST(linear_momentum(scene, at_one.columns()).dot(along) == pushed, boost::test_tools::tolerance(1e-13));
    for (std::size_t i = 2; i < 27; ++i) {
      const Vec3 contact = at_one.columns().velocity(i) + at_one.columns().angular_velocity(i).cross(Vec3(0, 0, -0.2));
      BOOST_TEST((contact - at_one.columns().velocity(1)).norm() < 1e-14);
    }
  }
}

BOOST_AUTO_TEST_CASE(two_bodies_keep_their_momentum_and_the_share_of_their_relative_speed) {
  for (const double e : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    Scene scene;
    scene.bodies = {test::on_its_own("a", Sphere{0.5}, 1, {-1, 0, 0}),
                    test::on_its_own("b", Sphere{0.5}, 3, {1, 0, 0})};
    scene.bodies[0].velocity = {1, 0, 0}, scene.bodies[1].velocity = {-1, 0, 0};
    scene.contact_default = {e, 0.5};
    const BodyTable after = truth_at(*make_truth("line-impacts", scene, 5), 3, 2);
    const double a = after.columns().velocity(0).x(), b = after.columns().velocity(1).x();
    BOOST_TEST(b - a == 2 * e, boost::test_tools::tolerance(1e-15));
    BOOST_TEST(a + 3 * b == -2, boost::test_tools::tolerance(1e-15));
    // They meet after half a second, at the origin.
    BOOST_TEST(after.columns().position(0).x() == -0.5 + 2.5 * a, boost::test_tools::tolerance(1e-14));
    BOOST_TEST(after.columns().position(1).x() == 0.5 + 2.5 * b, boost::test_tools::tolerance(1e-14));
  }
}

BOOST_AUTO_TEST_CASE(a_box_and_the_ball_it_hits_without_bounce_go_on_at_half_the_speed) {
  Scene scene;
  scene.bodies = {test::on_its_own("cube", Box{{1, 1, 1}}, 1, {-2, 0, 0}),
                  test::on_its_own("ball", Sphere{0.5}, 1, {0, 0, 0})};
  scene.bodies[0].velocity = {1, 0, 0};
  const BodyTable after = truth_at(*make_truth("line-impacts", scene, 5), 4, 2);
  BOOST_TEST(after.columns().velocity(0).x() == 0.5);
  BOOST_TEST(after.columns().velocity(1).x() == 0.5);
}

BOOST_AUTO_TEST_CASE(the_last_ball_of_a_cradle_leaves_with_the_speed_of_the_first) {
  for (const double gap : {0.0, 1e-3, 0.1}) {
    const Scene scene = test::row_of_spheres(5, gap, 1);
    const BodyTable after = truth_at(*make_truth("line-impacts", scene, 5), 3, 5);
    for (std::size_t i = 0; i < 5; ++i) {
      BOOST_TEST_CONTEXT("gap " << gap << ", ball " << i)
      BOOST_TEST(std::abs(after.columns().velocity(i).x() - (i == 4 ? 1 : 0)) < 1e-15);
    }
    BOOST_TEST(after.columns().position(4).x() == 4 * (1 + gap) + 3 - 1 - 4 * gap, boost::test_tools::tolerance(1e-14));
  }
}

BOOST_AUTO_TEST_CASE(a_row_without_full_restitution_loses_what_each_pair_takes) {
  // Spread apart, so that the first round of impacts goes down the row: each hands on (1 + e)/2 of its speed.
  const Scene scene = test::row_of_spheres(3, 0.1, 0.5);
  const BodyTable after = truth_at(*make_truth("line-impacts", scene, 5), 1.3, 3);
  BOOST_TEST(after.columns().velocity(2).x() == 0.75 * 0.75, boost::test_tools::tolerance(1e-15));
  const double momentum = linear_momentum(scene, after.columns()).x();
  BOOST_TEST(momentum == 1, boost::test_tools::tolerance(1e-15));
}

BOOST_AUTO_TEST_CASE(a_wall_stands_and_throws_back_what_hits_it) {
  Scene scene;
  scene.bodies = {test::on_its_own("shot", Box{{1, 1, 1}}, 1, {-10, 0, 0}),
                  test::on_its_own("wall", Box{{0.01, 9, 9}}, 1, {0, 0, 0})};
  scene.bodies[0].velocity = {400, 0, 0}, scene.bodies[1].fixed = true;
  for (const double e : {0.0, 0.5}) {
    scene.contact_default.restitution = e;
    const BodyState after = state_of(scene, "line-impacts", 1);
    BOOST_TEST(after.velocity.x() == -400 * e);
    BOOST_TEST(after.position.x() == -0.505 - 400 * e * (1 - (10 - 0.505) / 400), boost::test_tools::tolerance(1e-14));
  }
}

BOOST_AUTO_TEST_SUITE_END()
