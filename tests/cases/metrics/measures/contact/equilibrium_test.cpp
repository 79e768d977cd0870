// Which contact forces the equations of motion determine, and their sizes.
#include "cases/metrics/measures/contact/equilibrium.h"

#include <boost/test/unit_test.hpp>
#include <random>

#include "tests/scenes.h"

BOOST_AUTO_TEST_SUITE(cases_metrics_measures_contact_equilibrium)

using namespace rigor;

namespace {

MeetingPoint smooth(int first, int second, const Vec3& point, const Vec3& normal) {
  return {{first, second}, point, normal.normalized(), false, false};
}
MeetingPoint rough(int first, int second, const Vec3& point) {
  return {{first, second}, point, Vec3::UnitZ(), true, false};
}

ContactLoad fixed_body() { return {.is_fixed = true}; }
// A body at `centre` that needs `force` through it.
ContactLoad needs(const Vec3& force, const Vec3& centre) {
  return {force, centre.cross(force), centre, force.norm() + 1, false};
}

double distance(const Mat3& a, const Mat3& b) { return (a - b).norm(); }

}  // namespace

BOOST_AUTO_TEST_CASE(a_chain_of_bodies_has_the_sums_from_its_end) {
  const Vec3 up = Vec3::UnitZ();
  // A stack of three, the lowest last, with weights of 1, 2 and 4 N; body 3 is the ground.
  const std::vector<MeetingPoint> points = {rough(0, 1, {0, 0, 2}), rough(1, 2, {0, 0, 1}), rough(3, 2, {0, 0, 0})};
  const Equilibrium found = equilibrium_of(
      points, {needs(1 * up, {0, 0, 2.5}), needs(2 * up, {0, 0, 1.5}), needs(4 * up, {0, 0, 0.5}), fixed_body()});
  BOOST_TEST((found.pairs.at({0, 1}).wrench.force + up).norm() < 1e-15);  // the second is pressed down with 1 N
  BOOST_TEST((found.pairs.at({1, 2}).wrench.force + 3 * up).norm() < 1e-15);
  BOOST_TEST((found.pairs.at({3, 2}).wrench.force - 7 * up).norm() < 1e-15);
  for (const auto& [pair, due] : found.pairs) BOOST_TEST(counts_fully(due.force_counts));
  BOOST_TEST(found.unexplained.empty());
  BOOST_TEST(counts_fully(found.due({3, 0}).force_counts));  // they do not touch, so nothing is due
  BOOST_TEST(found.due({3, 0}).wrench.force.norm() == 0);
}

// Each wall carries m g / (2 sin a), with a the angle between a wall and the vertical: the vertical parts of both
// forces are N sin a. Friction may clamp the ball, so that nothing is known then.
BOOST_AUTO_TEST_CASE(a_groove_is_determined_without_friction_only) {
  const double weight = 98.1, radius = 0.1;
  const Vec3 left(0.8, 0, 0.6), right(-0.8, 0, 0.6);
  std::vector<MeetingPoint> points = {smooth(1, 0, -radius * left, left), smooth(2, 0, -radius * right, right)};
  const std::vector<ContactLoad> loads = {needs({0, 0, weight}, Vec3::Zero()), fixed_body(), fixed_body()};
  const Equilibrium found = equilibrium_of(points, loads);
  for (const auto& [pair, normal] : std::map<BodyPair, Vec3>{{{1, 0}, left}, {{2, 0}, right}}) {
    const DueWrench& due = found.pairs.at(pair);
    BOOST_TEST((due.wrench.force - 81.75 * normal).norm() < 1e-12);
    BOOST_TEST(distance(due.force_counts, Mat3::Identity()) < 1e-12);
    BOOST_TEST(due.wrench.moment.norm() < 1e-12);
  }
  for (MeetingPoint& point : points) point.has_friction = true;
  for (const auto& [pair, due] : equilibrium_of(points, loads).pairs) BOOST_TEST(!counts_fully(due.force_counts));
}

// One body on two supports at x = -1 and 1, with its weight at x = 1/3: they carry a third and two thirds. With
// friction the supports may also pull against each other along x, which no equation tells.
BOOST_AUTO_TEST_CASE(of_two_rough_supports_the_pulls_against_each_other_stay_open) {
  const std::vector<MeetingPoint> points = {rough(1, 0, {-1, -0.2, 0}), rough(1, 0, {-1, 0.2, 0}),
                                            rough(2, 0, {1, -0.2, 0}), rough(2, 0, {1, 0.2, 0})};
  const Equilibrium found = equilibrium_of(points, {needs({0, 0, 9}, {1.0 / 3, 0, 1}), fixed_body(), fixed_body()});
  const Mat3 vertical = Vec3(0, 0, 1).asDiagonal();
  for (const auto& [body, share] : std::map<int, double>{{1, 3.0}, {2, 6.0}}) {
    const DueWrench& due = found.pairs.at({body, 0});
    BOOST_TEST(distance(due.force_counts, vertical) < 1e-9);
    BOOST_TEST((due.force_counts * due.wrench.force - Vec3(0, 0, share)).norm() < 1e-12);
  }
}

// A table on four scales: no share is determined, whatever the friction.
BOOST_AUTO_TEST_CASE(four_supports_leave_all_shares_open) {
  std::vector<MeetingPoint> points;
  for (int leg = 0; leg < 4; ++leg)
    points.push_back(smooth(1 + leg, 0, {leg & 1 ? 1.0 : -1, leg & 2 ? 1.0 : -1, 0}, Vec3::UnitZ()));
  std::vector<ContactLoad> loads(5, fixed_body());
  loads[0] = needs({0, 0, 8}, {0.2, 0.1, 1});
  const Equilibrium found = equilibrium_of(points, loads);
  for (const auto& [pair, due] : found.pairs) {
    BOOST_TEST(!counts_fully(due.force_counts));
    BOOST_TEST(std::abs(due.force_counts(2, 2)) < 1e-9);  // the vertical force
  }
  points.pop_back();  // three supports are determined
  for (const auto& [pair, due] : equilibrium_of(points, loads).pairs) BOOST_TEST(counts_fully(due.force_counts));
}

// Known forces at random smooth points give the loads; the loads must give back the forces, or leave them open.
BOOST_AUTO_TEST_CASE(random_forces_are_found_again_where_they_are_said_to_be_determined) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto vector = [&] { return Vec3(any(random), any(random), any(random)); };
  int determined = 0, open = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const int fixed = 5, per_pair = 1 + trial % 3;
    std::vector<ContactLoad> loads(2 + fixed, fixed_body());
    for (int body : {0, 1}) loads[static_cast<std::size_t>(body)] = needs(Vec3::Zero(), vector());
    std::vector<BodyPair> pairs = {{0, 1}};
    for (int k = 0; k < fixed; ++k) pairs.push_back({2 + k, k % 2});
    std::vector<MeetingPoint> points;
    std::map<BodyPair, Vec3> truth;
    for (const BodyPair& pair : pairs) {
      for (int k = 0; k < per_pair; ++k) {
        points.push_back(smooth(pair.first, pair.second, vector(), vector()));
        const Vec3 force = any(random) * points.back().normal;
        truth.try_emplace(pair, Vec3::Zero()).first->second += force;
        for (const auto& [body, sign] : {std::pair(pair.second, 1), std::pair(pair.first, -1)}) {
          ContactLoad& load = loads[static_cast<std::size_t>(body)];
          load.force += sign * force, load.moment += sign * points.back().point.cross(force), load.scale += 1;
        }
      }
    }
    for (ContactLoad& load : loads)
      if (load.is_fixed) load = fixed_body();
    for (const auto& [pair, due] : equilibrium_of(points, loads).pairs) {
      const Vec3 error = due.force_counts * (due.wrench.force - truth.at(pair));
      BOOST_TEST(error.norm() < 1e-8);
      (counts_fully(due.force_counts) ? determined : open) += 1;
    }
  }
  BOOST_TEST(determined >= 100);  // 20 trials have 6 unknowns for 12 equations, and 20 have as many as equations
  BOOST_TEST(open >= 100);        // 20 trials have 18 unknowns
}

// An error of 1e-5 of the load is more than any rounding: something else holds the body.
BOOST_AUTO_TEST_CASE(a_load_that_no_contact_explains_leaves_the_body_open) {
  const Vec3 left(0.8, 0, 0.6), right(-0.8, 0, 0.6);
  const std::vector<MeetingPoint> points = {smooth(1, 0, -left, left), smooth(2, 0, -right, right)};
  const Equilibrium found =
      equilibrium_of(points, {needs({0, 1e-3, 100}, Vec3::Zero()), fixed_body(), fixed_body(), fixed_body()});
  BOOST_TEST(found.unexplained.contains(0));
  for (const BodyPair& pair : {BodyPair(1, 0), BodyPair(2, 0), BodyPair(3, 0)})
    BOOST_TEST(found.due(pair).force_counts.isZero(0));
  const Equilibrium nothing_near = equilibrium_of({}, {needs({0, 0, 1}, Vec3::Zero()), fixed_body()});
  BOOST_TEST(nothing_near.due({1, 0}).force_counts.isZero(0));
}

// One point of an area may also carry a couple: it stands for all points of the area.
BOOST_AUTO_TEST_CASE(a_point_that_stands_for_an_area_leaves_shares_open) {
  std::vector<MeetingPoint> points = {smooth(1, 0, {-1, 0, 0}, Vec3::UnitZ()), smooth(2, 0, {1, 0, 0}, Vec3::UnitZ())};
  const std::vector<ContactLoad> loads = {needs({0, 0, 9}, {1.0 / 3, 0, 1}), fixed_body(), fixed_body()};
  BOOST_TEST(std::abs(equilibrium_of(points, loads).pairs.at({2, 0}).wrench.force.z() - 6) < 1e-12);
  points[0].has_couple = true;
  for (const auto& [pair, due] : equilibrium_of(points, loads).pairs) BOOST_TEST(!counts_fully(due.force_counts));
}

BOOST_AUTO_TEST_SUITE_END()
