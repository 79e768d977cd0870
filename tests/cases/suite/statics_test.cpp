// An independent check of scenes that must stand, without code of any contact method. It looks for forces at the
// contact points, each inside its friction cone, that balance every weight. If they exist, the pile may stand (the safe
// theorem of masonry: Heyman, The stone skeleton, Int. J. Solids Struct. 2, 1966); if not, it must fall. Points are
// corners and ends of axes, found by separate geometry. A cone is approximated from inside by kSides sides, so a
// solution within it is valid. Lawson's and Hanson's least squares find the forces.
#include <Eigen/QR>
#include <array>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "core/scene/contact_laws.h"
#include "tests/cases/suite/suite_checks.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_suite_statics)

namespace {

constexpr double kTouching = 1e-6;  // m: scenes are written down to 1e-12
constexpr int kSides = 16;

struct Point {
  int a, b;  // the force on a is inside the cone about the normal
  Vec3 at, normal;
};

Vec3 in_W(const Body& body, const Vec3& p) { return body.position + body.orientation * p; }

std::vector<Vec3> corners_of(const Body& body) {
  std::vector<Vec3> corners;
  const Vec3 half = 0.5 * std::get<Box>(*body.shape).size;
  for (int k = 0; k < 8; ++k)
    corners.push_back(in_W(body, half.cwiseProduct(Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1))));
  return corners;
}

std::array<Vec3, 2> ends_of(const Body& body) {
  const double half = 0.5 * std::get<Capsule>(*body.shape).length;
  return {in_W(body, {0, 0, -half}), in_W(body, {0, 0, half})};
}

// Outward, of the sides of a box that a point of its surface lies on; none if it is not on the surface.
std::vector<Vec3> sides_at(const Body& box, const Vec3& p) {
  const Vec3 half = 0.5 * std::get<Box>(*box.shape).size, in_B = box.orientation.conjugate() * (p - box.position);
  std::vector<Vec3> sides;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(in_B[i]) > half[i] + kTouching) return {};
    if (std::abs(in_B[i]) > half[i] - kTouching)
      sides.push_back(box.orientation * Vec3(std::copysign(1.0, in_B[i]) * Vec3::Unit(i)));
  }
  return sides;
}

bool parts(const Vec3& n, const Vec3& p, const Body& above, const Body& below) {
  for (const Vec3& corner : corners_of(above)) {
    if (n.dot(corner - p) < -kTouching) return false;
  }
  for (const Vec3& corner : corners_of(below)) {
    if (n.dot(corner - p) > kTouching) return false;
  }
  return true;
}

// Points from b to a: a face normal of either that separates the two, or between edges the direction midway between
// their faces.
void touch_boxes(const Scene& scene, int a, int b, std::vector<Point>& out) {
  const Body &of_a = scene.bodies[a], &of_b = scene.bodies[b];
  for (const Vec3& p : corners_of(of_a)) {
    const std::vector<Vec3> from_b = sides_at(of_b, p), from_a = sides_at(of_a, p);
    if (from_b.empty()) continue;
    std::vector<Vec3> choices = from_b;
    Vec3 midway = Vec3::Zero();
    for (const Vec3& n : from_b) midway += n;
    for (const Vec3& n : from_a) choices.push_back(-n), midway -= n;
    choices.push_back(midway.normalized());
    for (const Vec3& n : choices) {
      if (!parts(n, p, of_a, of_b)) continue;
      out.push_back({a, b, p, n});
      break;
    }
  }
}

// For logs that lie side by side.
void touch_capsules(const Scene& scene, int a, int b, std::vector<Point>& out) {
  const double reach =
      std::get<Capsule>(*scene.bodies[a].shape).radius + std::get<Capsule>(*scene.bodies[b].shape).radius;
  const auto ends_a = ends_of(scene.bodies[a]), ends_b = ends_of(scene.bodies[b]);
  for (const Vec3& p : ends_a) {
    for (const Vec3& q : ends_b) {
      if (std::abs((p - q).norm() - reach) > kTouching) continue;
      const Vec3 n = (p - q).normalized();
      out.push_back({a, b, q + std::get<Capsule>(*scene.bodies[b].shape).radius * n, n});
    }
  }
}

void touch_plane(const Scene& scene, int a, int plane, std::vector<Point>& out) {
  const Plane& ground = std::get<Plane>(*scene.bodies[plane].shape);
  const Body& body = scene.bodies[a];
  const auto add = [&](const Vec3& p, double radius) {
    if (std::abs(ground.normal.dot(p) - ground.offset - radius) < kTouching)
      out.push_back({a, plane, p - radius * ground.normal, ground.normal});
  };
  if (std::holds_alternative<Box>(*body.shape)) {
    for (const Vec3& p : corners_of(body)) add(p, 0);
  } else {
    for (const Vec3& p : ends_of(body)) add(p, std::get<Capsule>(*body.shape).radius);
  }
}

std::vector<Point> points_of(const Scene& scene) {
  std::vector<Point> points;
  const int count = static_cast<int>(scene.bodies.size());
  for (int a = 0; a < count; ++a) {
    for (int b = 0; b < count; ++b) {
      if (a == b || scene.bodies[a].fixed) continue;
      const Shape &of_a = *scene.bodies[a].shape, &of_b = *scene.bodies[b].shape;
      if (std::holds_alternative<Plane>(of_b)) touch_plane(scene, a, b, points);
      if (std::holds_alternative<Box>(of_a) && std::holds_alternative<Box>(of_b)) touch_boxes(scene, a, b, points);
      if (std::holds_alternative<Capsule>(of_a) && std::holds_alternative<Capsule>(of_b) && a < b)
        touch_capsules(scene, a, b, points);
    }
  }
  return points;
}

// The x >= 0 that brings A x nearest to b.
Eigen::VectorXd nearest(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(A.cols());
  std::vector<Eigen::Index> used;
  const auto solve = [&] {
    Eigen::MatrixXd columns(A.rows(), static_cast<Eigen::Index>(used.size()));
    for (std::size_t k = 0; k < used.size(); ++k) columns.col(static_cast<Eigen::Index>(k)) = A.col(used[k]);
    return Eigen::VectorXd(columns.colPivHouseholderQr().solve(b));
  };
  for (int round = 0; round < 3 * A.cols(); ++round) {
    const Eigen::VectorXd slope = A.transpose() * (b - A * x);
    Eigen::Index best = -1;
    for (Eigen::Index i = 0; i < slope.size(); ++i) {
      if (std::find(used.begin(), used.end(), i) == used.end() && (best < 0 || slope[i] > slope[best])) best = i;
    }
    if (best < 0 || slope[best] <= 1e-11 * b.norm()) break;
    used.push_back(best);
    for (Eigen::VectorXd s = solve(); !used.empty(); s = solve()) {
      double share = 1;
      for (std::size_t k = 0; k < used.size(); ++k) {
        const double from = x[used[k]], to = s[static_cast<Eigen::Index>(k)];
        if (to <= 0) share = std::min(share, from > to ? from / (from - to) : 0);
      }
      for (std::size_t k = 0; k < used.size(); ++k)
        x[used[k]] += share * (s[static_cast<Eigen::Index>(k)] - x[used[k]]);
      if (share == 1) break;
      std::erase_if(used, [&](Eigen::Index i) { return x[i] <= 1e-13 * b.norm() ? (x[i] = 0, true) : false; });
    }
  }
  return x;
}

// The part of the weights that no forces within the cones carry; 0 where the pile may stand.
double uncarried(const Scene& scene, double friction) {
  const std::vector<Point> points = points_of(scene);
  const auto rows = static_cast<Eigen::Index>(6 * scene.bodies.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(kSides * points.size()));
  Eigen::VectorXd b = Eigen::VectorXd::Zero(rows);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (!scene.bodies[i].fixed) b.segment<3>(6 * i) = -scene.bodies[i].mass * scene.gravity;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& point = points[i];
    const Vec3 t = point.normal.unitOrthogonal(), s = point.normal.cross(t);
    for (int k = 0; k < kSides; ++k) {
      const double angle = 2 * std::numbers::pi * k / kSides;
      const Vec3 force = point.normal + friction * (std::cos(angle) * t + std::sin(angle) * s);
      for (const auto& [body, sign] : {std::pair(point.a, 1.0), std::pair(point.b, -1.0)}) {
        if (scene.bodies[body].fixed) continue;
        const Vec3 torque = (point.at - scene.bodies[body].position).cross(force);
        A.block<6, 1>(6 * body, static_cast<Eigen::Index>(kSides * i) + k) << sign * force, sign * torque;
      }
    }
  }
  return (A * nearest(A, b) - b).norm() / b.norm();
}

struct Pile {
  const char* id;
  double falls;  // at this friction
  const char* because;
};
std::ostream& operator<<(std::ostream& out, const Pile& pile) { return out << pile.id; }

const Pile kPiles[] = {
    {"contact/card-house", 0.12, "each foot asks for tan(15°)/2 = 0.134 of the weight on it"},
    {"contact/log-pile", 0.25, "each contact needs tan(15°) = 0.268"},
    {"contact/keystone-arch", 0.21, "a leg's lowest and highest joints ask for tan 12.3° = 0.219, see the case"},
    {"contact/corbel-arch", -1, "nothing pushes sideways: it stands without friction"},
};

}  // namespace

BOOST_DATA_TEST_CASE(what_has_to_stand_is_balanced_by_forces_within_the_friction_cones, kPiles, pile) {
  const Case c = select_cases({pile.id}, default_suite_dir(), test::words()).at(0);
  // Rounding of the positions, 1e-12 m of 1 m, a hundred times over.
  BOOST_TEST(uncarried(c.scene, c.scene.contact_default.friction) < 1e-10);
  if (pile.falls < 0) return;
  BOOST_TEST(uncarried(c.scene, pile.falls) > 1e-3, pile.because);
}

BOOST_AUTO_TEST_SUITE_END()
