// The impulses of touching bodies satisfy the contact laws; measures how near sweeps come to them.
#include "core/dynamics/contact/event/cone_solver.h"

#include "core/dynamics/contact/event/contact_points.h"
#include "core/dynamics/contact/event/impacts.h"
#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_event_cone_solver)

namespace {

constexpr double kFriction = 0.5;
constexpr double kStep = 1.0 / 120;  // s, of free fall before the impulses

// A scene after a step of free fall, and its points.
struct Touching {
  explicit Touching(const Scene& scene) : system(scene), contact_points(scene), state(scene.bodies.size()) {
    set_initial_state(scene, state.columns());
    std::vector<ContactPoint> found;
    contact_points.find(columns(), contact_points.candidates(columns()), 1e-10, found);
    for (const ContactPoint& contact : found) points.push_back(contact.cone);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      if (!scene.bodies[i].fixed) state.columns().set_velocity(i, columns().velocity(i) + kStep * scene.gravity);
    }
  }
  BodyColumns columns() const { return state.columns(); }
  Vec3 velocity_at(const ConeConstraint& point) const { return ConeSolver::velocity_at(point, columns()); }

  System system;
  ContactPoints contact_points;
  BodyTable state;
  std::vector<ConeConstraint> points;
};

Scene stack(int count, const Vec3& velocity) {
  std::vector<Body> boxes;
  for (int i = 0; i < count; ++i) {
    boxes.push_back(solid("box", Box{{0.2, 0.2, 0.2}}, {0, 0, 0.1 + 0.2 * i}));
    boxes.back().velocity = velocity;
  }
  return on_floor(boxes, {0, kFriction});
}

void check_laws(const Touching& scene, double tolerance) {
  for (const ConeConstraint& point : scene.points) {
    const Vec3 u = scene.velocity_at(point), p = point.impulse;
    BOOST_TEST(u.x() > -tolerance);
    BOOST_TEST(p.x() >= 0);
    BOOST_TEST(p.tail<2>().norm() <= kFriction * p.x() * (1 + 1e-12));
    if (p.x() > 0) BOOST_TEST(std::abs(u.x()) < tolerance);
    const double slip = u.tail<2>().norm();
    if (slip < tolerance) continue;
    // At the rim, against the slip.
    BOOST_TEST((p.tail<2>() + kFriction * p.x() / slip * u.tail<2>()).norm() < tolerance * (1 + p.x() / slip));
  }
}

}  // namespace

// A box whose corners all slide, turning as they do: each point's direction of friction is its own.
BOOST_AUTO_TEST_CASE(what_slides_and_turns_is_braked_against_each_points_own_slip) {
  Scene scene = stack(1, {0.3, 0.1, 0});
  scene.bodies[0].angular_velocity = {0, 0, 4};
  Touching box(scene);
  ConeSolver solver(box.system);
  solver.prepare(box.columns(), box.points);
  BOOST_TEST(box.points.size() == 4u);
  BOOST_TEST(solver.solve(box.state.columns(), box.points));
  check_laws(box, 1e-12);
}

// Ten boxes one on the other pass a weight down by one box a sweep, and to and fro: what creeps so is taken at once.
BOOST_AUTO_TEST_CASE(leaps_find_what_creeps_in_as_many_sweeps) {
  constexpr ConeAccuracy kCrowded{.at_rest = 1e-4, .near_rest = 5e-2, .most_turns = 2, .by_newton = false};
  constexpr long kMost = 60;  // sweeps, in two turns
  const auto fastest_approach = [&](ConeSolver::Means means) {
    Touching boxes(stack(10, Vec3::Zero()));
    ConeSolver solver(boxes.system, kCrowded);
    solver.prepare(boxes.columns(), boxes.points);
    const double before = kinetic_energy(boxes.system, boxes.columns());
    BOOST_TEST(solver.solve(boxes.state.columns(), boxes.points, means));
    BOOST_TEST(solver.sweeps() <= kMost);
    BOOST_TEST(kinetic_energy(boxes.system, boxes.columns()) <= before);
    double fastest = 0;
    for (const ConeConstraint& point : boxes.points) fastest = std::max(fastest, -boxes.velocity_at(point).x());
    return fastest;
  };
  const double with = fastest_approach(ConeSolver::Means::all), without = fastest_approach(ConeSolver::Means::sweeps);
  BOOST_TEST(with < 0.1 * without, with << " and " << without << " m/s");  // 2e-4 and 9e-3
}

BOOST_AUTO_TEST_SUITE_END()
