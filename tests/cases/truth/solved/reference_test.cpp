#include <boost/test/unit_test.hpp>
#include <limits>

#include "core/base/error.h"
#include "core/dynamics/model/energy.h"
#include "tests/cases/truth/closed_form/smooth/smooth_scenes.h"

using namespace rigor;
using test::truth_at;

BOOST_AUTO_TEST_SUITE(cases_truth_solved_reference)

namespace {

// A second solver, written separately: rotation matrices and momenta, the classical Runge-Kutta method with equal steps
// of three sizes, and Richardson's extrapolation of the three (its error then begins with h^6). It supports springs
// between bodies and to the world, and dampers; no timed forces.
class MatrixSolver {
 public:
  explicit MatrixSolver(const Scene& scene) : scene_(scene) {}

  std::vector<Vec3> positions(double t, long steps) const {
    const Points coarse = march(t, steps), middle = march(t, 2 * steps), fine = march(t, 4 * steps);
    std::vector<Vec3> positions;
    for (std::size_t i = 0; i < fine.size(); ++i) {
      const V first = middle[i].x + (middle[i].x - coarse[i].x) / 15,
              second = fine[i].x + (fine[i].x - middle[i].x) / 15;
      positions.push_back((second + (second - first) / 31).cast<double>());
    }
    return positions;
  }

 private:
  using N = long double;
  using V = Eigen::Matrix<N, 3, 1>;
  using M = Eigen::Matrix<N, 3, 3>;
  struct Point {
    V x, p, L;  // position, momentum, angular momentum
    M R;
  };
  using Points = std::vector<Point>;

  static M skew(const V& a) { return (M() << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0).finished(); }
  V spin(const Point& s, int i) const {
    return s.R * scene_.bodies[i].inertia.cast<N>().inverse() * s.R.transpose() * s.L;
  }

  Points rates(const Points& s) const {
    Points d(s.size());
    for (std::size_t i = 0; i < s.size(); ++i) {
      const N m = scene_.bodies[i].mass;
      d[i] = {s[i].p / m, m * scene_.gravity.cast<N>(), V::Zero(), skew(spin(s[i], i)) * s[i].R};
    }
    for (const Spring& spring : scene_.springs) {
      V end[2], speed[2], arm[2];
      const int who[2] = {spring.a, spring.b};
      for (int k = 0; k < 2; ++k) {
        const V point = (k == 0 ? spring.point_a : spring.point_b).cast<N>();
        end[k] = point, speed[k] = V::Zero(), arm[k] = V::Zero();
        if (who[k] == kWorld) continue;
        const Point& body = s[who[k]];
        arm[k] = body.R * point, end[k] = body.x + arm[k];
        speed[k] = body.p / N(scene_.bodies[who[k]].mass) + skew(spin(body, who[k])) * arm[k];
      }
      const V u = (end[1] - end[0]).normalized();
      const N pull = N(spring.stiffness) * ((end[1] - end[0]).norm() - N(spring.rest_length)) +
                     N(spring.damping) * u.dot(speed[1] - speed[0]);
      for (int k = 0; k < 2; ++k) {
        if (who[k] == kWorld) continue;
        const V force = (k == 0 ? pull : -pull) * u;
        d[who[k]].p += force, d[who[k]].L += skew(arm[k]) * force;
      }
    }
    return d;
  }

  static Points moved(const Points& s, const Points& d, N h) {
    Points r = s;
    for (std::size_t i = 0; i < s.size(); ++i) {
      r[i].x += h * d[i].x, r[i].p += h * d[i].p, r[i].L += h * d[i].L, r[i].R += h * d[i].R;
    }
    return r;
  }

  Points march(double t, long steps) const {
    Points s;
    for (const Body& body : scene_.bodies) {
      const M R = Eigen::Quaternion<N>(body.orientation.cast<N>()).normalized().toRotationMatrix();
      const V L = R * body.inertia.cast<N>() * R.transpose() * body.angular_velocity.cast<N>();
      s.push_back({body.position.cast<N>(), N(body.mass) * body.velocity.cast<N>(), L, R});
    }
    const N h = N(t) / steps;
    for (long n = 0; n < steps; ++n) {
      const Points a = rates(s), b = rates(moved(s, a, h / 2)), c = rates(moved(s, b, h / 2)),
                   d = rates(moved(s, c, h));
      s = moved(moved(moved(moved(s, a, h / 6), b, h / 3), c, h / 3), d, h / 6);
    }
    return s;
  }

  const Scene& scene_;
};

Scene five_bodies() {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  for (int i = 0; i < 5; ++i) {
    Body body = test::body("body " + std::to_string(i), 1 + i, {0.1 + 0.02 * i, 0.15, 0.2}, {0.5 * i, 0.1 * i, 0});
    body.inertia(0, 1) = body.inertia(1, 0) = 0.02, body.inertia(1, 2) = body.inertia(2, 1) = -0.01;
    body.angular_velocity = {1, -0.5 * i, 2};
    scene.bodies.push_back(body);
    scene.springs.push_back(test::spring(i - 1, {0.1, 0.1, 0.1}, i, {-0.1, 0, 0.1}, 300, 0.3, 2));
  }
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_agrees_with_a_solver_written_apart_from_it) {
  struct Row {
    const char* name;
    Scene scene;
    std::vector<double> times;
    long steps_a_second;
  };
  // 1e-9 m asks of the second solver steps of a two-thousandth of a second: the difference halves its digits with more.
  const Row rows[] = {{"fixed spring", test::fixed_spring(), {1, 2, 5, 10}, 2000},
                      {"body springs", test::body_springs(), {1, 2, 5}, 2000},
                      {"five bodies", five_bodies(), {1, 2}, 2000}};
  for (const Row& row : rows) {
    const auto truth = make_truth("reference", row.scene, row.times.back());
    for (const double t : row.times) {
      const auto expected = MatrixSolver(row.scene).positions(t, static_cast<long>(t) * row.steps_a_second);
      const BodyTable found = truth_at(*truth, t, row.scene.bodies.size());
      for (std::size_t i = 0; i < expected.size(); ++i) {
        const double difference = (found.columns().position(i) - expected[i]).norm();
        BOOST_TEST_MESSAGE(row.name << ", t = " << t << ": " << difference << " m, own estimate " << truth->error(t));
        BOOST_TEST_CONTEXT(row.name << ", t = " << t << ", body " << i) BOOST_TEST(difference < 1e-9);
      }
    }
  }
}

// The free axisymmetric body of Kane (1983): transverse .04, axial .02, w_B = (2, 4, 6).
BOOST_AUTO_TEST_CASE(it_reproduces_the_axisymmetric_bodys_closed_form) {
  Scene scene;
  scene.bodies = {test::body("top", 1, {0.04, 0.04, 0.02})};
  scene.bodies[0].angular_velocity = {2, 4, 6};
  const auto truth = make_truth("reference", scene, 20);
  for (const double t : {1.0, 7.3, 20.0}) {
    const BodyTable now = truth_at(*truth, t, 1);
    const Vec3 w_B = now.columns().orientation(0).conjugate() * now.columns().angular_velocity(0);
    const Vec3 expected(2 * std::cos(3 * t) + 4 * std::sin(3 * t), 4 * std::cos(3 * t) - 2 * std::sin(3 * t), 6);
    BOOST_TEST((w_B - expected).norm() < 1e-12);  // a hundred roundings of 7 rad/s
  }
}

// Printed figures of the Dzhanibekov box and of the tumbling brick of NESC's check-case 2, to every digit.
BOOST_AUTO_TEST_CASE(it_reproduces_published_tumbling) {
  Scene box;
  const double m = 10, a = 0.1, b = 0.4, c = 0.9;
  box.gravity = {0, 0, -9.8};
  box.bodies = {test::body("box", m, {m / 12 * (b * b + c * c), m / 12 * (a * a + c * c), m / 12 * (a * a + b * b)})};
  box.bodies[0].velocity = {-2, 2, 8}, box.bodies[0].angular_velocity = {0.1, 5, 0.1};
  const BodyTable box_at_10 = truth_at(*make_truth("reference", box, 10), 10, 1);
  const Quat q = box_at_10.columns().orientation(0);
  const Vec3 w_B = q.conjugate() * box_at_10.columns().angular_velocity(0);
  BOOST_TEST((w_B - Vec3(2.7558404, -3.7359635, -3.1618090)).cwiseAbs().maxCoeff() < 0.6e-7);
  BOOST_TEST(angle_between(q, Quat(0.2251646, -0.6199276, -0.2770292, 0.6987457).normalized()) < 2e-7);

  constexpr double kDegree = 0.017453292519943295;
  Scene brick;
  brick.bodies = {test::body("brick", 1, {0.001894220, 0.006211019, 0.007194665})};
  brick.bodies[0].angular_velocity = kDegree * Vec3(10, 20, 30);
  const BodyTable brick_at_30 = truth_at(*make_truth("reference", brick, 30), 30, 1);
  const Vec3 w = brick_at_30.columns().orientation(0).conjugate() * brick_at_30.columns().angular_velocity(0) / kDegree;
  BOOST_TEST((w - Vec3(12.618391, -17.397475, 31.119589)).cwiseAbs().maxCoeff() < 0.6e-6);
}

// What a scene that is new to it may ask of it.
BOOST_AUTO_TEST_CASE(its_error_is_small_for_many_bodies_near_a_separatrix_for_stiff_springs_and_over_a_minute) {
  Scene stiff = test::fixed_spring();
  stiff.springs[0].stiffness = 1e8;  // 1000 rad/s, and as much in the rotation
  struct Row {
    const char* name;
    Scene scene;
    double duration, most;  // s; m and rad
  };
  const Row rows[] = {
      {"five bodies", five_bodies(), 5, 1e-10},
      {"near a separatrix", test::free_body(Vec3(1, 2, 3), 5 * Vec3(1e-8, 1, 1e-8)), 60, 1e-10},
      {"stiff", stiff, 1, 1e-10},
      {"free top for a minute", test::free_body(Vec3(1, 2, 3), {1, 2, 3}), 60, 1e-12},
  };
  for (const Row& row : rows) {
    const auto truth = make_truth("reference", row.scene, row.duration);
    BOOST_TEST_CONTEXT(row.name) BOOST_TEST(truth->error(row.duration) < row.most);
  }
}

BOOST_AUTO_TEST_CASE(energy_and_momentum_stay_what_they_were) {
  for (const Scene& scene : {test::fixed_spring(), test::tumbling_body()}) {
    const auto truth = make_truth("reference", scene, 10);
    const BodyTable start = truth_at(*truth, 0, 1);
    for (const double t : {0.1, 3.0, 10.0}) {
      const BodyTable now = truth_at(*truth, t, 1);
      const double e = energy(scene, start.columns());
      BOOST_TEST(std::abs(energy(scene, now.columns()) - e) < 1e-12 * std::abs(e));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_force_that_begins_and_ends_between_two_samples_gives_its_whole_impulse) {
  Scene scene;
  scene.bodies = {test::body("body", 2, {1, 1, 1})};
  TimedForce force;
  force.body = 0, force.force = {6, 0, 0}, force.torque = {0, 0, 4}, force.from = 1.0 / 3, force.until = 1.4;
  scene.forces = {force};
  const auto truth = make_truth("reference", scene, 5);
  for (const double t : {0.3, 1.0, 1.4, 5.0}) {
    const BodyTable now = truth_at(*truth, t, 1);
    // a = 3 and alpha = 4 while it acts.
    const double on = std::clamp(t - 1.0 / 3, 0.0, 1.4 - 1.0 / 3), after = std::max(0.0, t - 1.4);
    BOOST_TEST(std::abs(now.columns().position(0).x() - (1.5 * on * on + 3 * on * after)) < 1e-13);  // roundings
    BOOST_TEST(std::abs(now.columns().angular_velocity(0).z() - 4 * on) < 1e-13);
    BOOST_TEST(angle_between(now.columns().orientation(0), rotation_by(Vec3(0, 0, 2 * on * on + 4 * on * after))) <
               1e-13);
  }
}

// Chaos makes the error grow until the second solver can measure it. The estimate must not be below the true error, nor
// absurdly above it.
BOOST_AUTO_TEST_CASE(the_error_estimate_is_neither_too_small_nor_absurdly_large) {
  const Scene scene = test::body_springs();
  const auto truth = make_truth("reference", scene, 30);
  double often = 0;  // by how much the estimate is too large where it is least so: one instant may agree by chance
  for (const double t : {8.0, 9.0, 10.0, 11.0}) {
    const auto expected = MatrixSolver(scene).positions(t, static_cast<long>(t) * 4000);
    const BodyTable found = truth_at(*truth, t, 2);
    double difference = 0;
    for (int i = 0; i < 2; ++i) difference = std::max(difference, (found.columns().position(i) - expected[i]).norm());
    BOOST_TEST_MESSAGE("at " << t << " s off by " << difference << " m at most; estimate " << truth->error(t));
    BOOST_TEST(truth->error(t) >= difference);
    often = std::max(often, difference / truth->error(t));
  }
  BOOST_TEST(often > 0.01);
  BOOST_TEST(truth->error(11) < 1e-10);  // two solutions in double precision part by 1e-10 at 11.7 s
  // Long before that, the estimate is a few roundings: 4 ulp of 1.4 m.
  BOOST_TEST(truth->error(1) < 1e-14);
  BOOST_TEST(truth->error(0) > 0);
  for (double s = 0.1; s <= 30; s += 0.1) BOOST_TEST(truth->error(s) >= truth->error(s - 0.1));
  // Two double-precision solutions part by 1e-6 at 17.8 s and by 1e-2 at 24.9 s; ours has 11 bits more, which at a
  // growth of 1.3 /s are worth up to 5.9 s.
  for (const auto& [tolerance, in_double] : {std::pair{1e-10, 11.7}, {1e-6, 17.8}, {1e-2, 24.9}}) {
    const double reach = horizon(*truth, tolerance, 30);
    BOOST_TEST_MESSAGE("the estimate passes " << tolerance << " at " << reach << " s");
    BOOST_TEST(reach > in_double);
    BOOST_TEST(reach < in_double + 5.9);
  }
}

BOOST_AUTO_TEST_CASE(it_gives_the_same_bits_each_time) {
  const auto once = make_truth("reference", test::body_springs(), 5),
             again = make_truth("reference", test::body_springs(), 5);
  for (const double t : {0.01, 1.0, 4.999}) {
    const BodyTable a = truth_at(*once, t, 2), b = truth_at(*again, t, 2);
    for (int c = 0; c < 13; ++c) BOOST_TEST(a.columns().column(c)[1] == b.columns().column(c)[1]);
    BOOST_TEST(once->error(t) == again->error(t));
  }
}

BOOST_AUTO_TEST_CASE(a_fixed_body_holds_its_springs_like_the_world) {
  Scene scene = test::fixed_spring(), anchored = scene;
  Body anchor = test::body("anchor", 1, {1, 1, 1}, {0.12, 2, 0.12});
  anchor.fixed = true;
  anchored.bodies.push_back(anchor);
  anchored.springs[0].a = 1, anchored.springs[0].point_a.setZero();
  const auto truth = make_truth("reference", scene, 2), same = make_truth("reference", anchored, 2);
  const BodyTable a = truth_at(*truth, 2, 1), b = truth_at(*same, 2, 2);
  BOOST_TEST((a.columns().position(0) - b.columns().position(0)).norm() < 1e-13);  // rounding
  BOOST_TEST((b.columns().position(1) - anchor.position).norm() == 0);
}

BOOST_AUTO_TEST_CASE(where_the_motion_is_not_smooth_the_truth_says_it_knows_no_more) {
  // A body drawn along the line through the spring's end: the force jumps from one side to the other there.
  Scene scene;
  scene.bodies = {test::body("bead", 1, {1, 1, 1}, {1, 0, 0})};
  scene.springs = {test::spring(kWorld, {0, 0, 0}, 0, {0, 0, 0}, 1, 3)};
  scene.bodies[0].velocity = {-5, 0, 0};
  const auto truth = make_truth("reference", scene, 2);
  BOOST_TEST(truth->error(0.05) < 1e-13);
  BOOST_TEST(truth->error(2) > 1e-6);
  BOOST_TEST(std::isfinite(truth_at(*truth, 2, 1).columns().position(0).x()));
}

BOOST_AUTO_TEST_CASE(contacts_are_refused) {
  BOOST_CHECK_EXCEPTION(make_truth("reference", test::dropped_sphere(1), 1), InputError, test::says("may touch"));
}

BOOST_AUTO_TEST_SUITE_END()
