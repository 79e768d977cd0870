// Contact that lasts: it keeps the integrator's order, and its modes change where the laws of friction say so.
#include <cmath>
#include <numbers>
#include <tuple>

#include "cases/truth/solved/events/equivalent_scene.h"
#include "core/dynamics/model/energy.h"
#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_event_held_contact)

namespace {

constexpr double kG = 9.81;

// A box that turns at `rate` about its lower edge at x = width/2.
Scene on_edge(double width, double height, double rate, double friction) {
  Body box = solid("box", Box{{width, 0.1, height}}, {0, 0, 0.5 * height});
  box.angular_velocity = {0, rate, 0};
  box.velocity = box.angular_velocity.cross(Vec3(-0.5 * width, 0, 0.5 * height));
  return on_floor({box}, {0, friction});
}

// The angle after t by the classical Runge-Kutta method on phi'' = g r/k² sin phi alone, in 1e5 steps: 1e-15.
double angle_of_pendulum(double width, double height, double rate, double t) {
  const double r = 0.5 * std::hypot(width, height), stiffness = kG * r / (r * r / 3 + r * r);
  double phi = -std::atan2(width, height), w = rate;
  constexpr int kSteps = 100000;
  const double h = t / kSteps;
  const auto f = [&](double x) { return stiffness * std::sin(x); };
  for (int n = 0; n < kSteps; ++n) {
    const double k1 = w, l1 = f(phi), k2 = w + 0.5 * h * l1, l2 = f(phi + 0.5 * h * k1), k3 = w + 0.5 * h * l2,
                 l3 = f(phi + 0.5 * h * k2), k4 = w + h * l3, l4 = f(phi + h * k3);
    phi += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), w += h / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
  }
  return phi + std::atan2(width, height);
}

double error_of_toppling(const char* integrator, int steps) {
  ContactRun run(on_edge(0.4, 1, 1.6, 1), "event", integrator);
  run.run(0.8 / steps, steps);
  BOOST_TEST(run.solver_warning() == "");
  return std::abs(angle_between(run.state().orientation(0), Quat::Identity()) - angle_of_pendulum(0.4, 1, 1.6, 0.8));
}

// Steps of `dt` until t; whether the energy ever rose by more than `rounding` of what it was at first.
void check_energy(const Scene& scene, ContactRun& run, double dt, double t, double rounding) {
  const double start = rigor::energy(scene, run.state());
  double last = start;
  while (run.time() < t - 0.5 * dt) {
    run.step(dt);
    const double now = rigor::energy(scene, run.state());
    if (now > last + rounding * std::abs(start)) BOOST_TEST(now <= last, "at " << run.time());
    last = std::min(last, now);
  }
}

// Six boxes side by side on a slope, whose gravity is tilted instead; three have too little friction.
struct BoxesOnSlope {
  BoxesOnSlope(double slope, double share) : theta(std::atan(slope)) {
    std::vector<Body> boxes;
    for (int i = 0; i < 6; ++i)
      boxes.push_back(solid("box " + std::to_string(i), Box{{0.4, 0.4, 0.1}}, {0, 1.0 * i, 0.05}, 10));
    scene = on_floor(boxes, {0, 0}, kG * Vec3(std::sin(theta), 0, -std::cos(theta)));
    const double shares[] = {share, 0.95, 0.99, 1.01, 1.05, 1 / share};
    for (int i = 0; i < 6; ++i) scene.contact_pairs.push_back({i, 6, {0, shares[i] * slope}});
  }
  // m, down the slope after 1 s.
  double due(int i) const {
    const double pull = kG * (std::sin(theta) - scene.contact_pairs[i].law.friction * std::cos(theta));
    return 0.5 * std::max(0.0, pull);
  }

  double theta;  // rad
  Scene scene;
};

}  // namespace

BOOST_AUTO_TEST_CASE(a_box_that_topples_without_slipping_keeps_the_order_of_the_integrator) {
  for (const char* integrator : {"rk4", "rkmk4", "velocity-verlet", "symplectic4"}) {
    const double at_30 = error_of_toppling(integrator, 24), at_60 = error_of_toppling(integrator, 48),
                 at_120 = error_of_toppling(integrator, 96);
    // The next term is some h/0.3 s of the leading one.
    BOOST_TEST(std::log2(at_30 / at_60) > 3.8, integrator << ": " << at_30 << ", " << at_60);
    BOOST_TEST(std::log2(at_60 / at_120) > 3.9, integrator << ": " << at_60 << ", " << at_120);
  }
  for (const int steps : {24, 80, 800}) {
    // The tolerance of a step, 1e-12, of which the unstable pendulum makes up to twenty times as much.
    BOOST_TEST(error_of_toppling("dormand-prince", steps) < 2e-11, steps);
    BOOST_TEST(error_of_toppling("symplectic8", steps) < 2e-11, steps);
  }
}

BOOST_AUTO_TEST_CASE(a_tall_box_that_is_nudged_about_its_edge_turns) {
  ContactRun run(on_edge(0.1, 2, 0.2, 0.5), "event", "dormand-prince");
  run.run(1.0 / 30, 30);
  BOOST_TEST(run.solver_warning() == "");
  const double angle = angle_between(run.state().orientation(0), Quat::Identity());
  BOOST_TEST(std::abs(angle - angle_of_pendulum(0.1, 2, 0.2, 1)) < 1e-11);
}

// Angular momentum about the edge that trips it: 2/3 s² w = v s/2.
BOOST_AUTO_TEST_CASE(infinite_friction_trips_a_cube_that_is_thrown_along_the_floor) {
  const double s = 1, v = 3;
  Body cube = solid("cube", Box{{s, s, s}}, {0, 0, 0.5 * s});
  cube.velocity = {v, 0, 0};
  const Scene scene = on_floor({cube}, {0, kInfiniteFriction});
  ContactRun run(scene, "event", "rk4");
  run.step(1e-6);
  BOOST_TEST(std::abs(run.state().angular_velocity(0).y() - 0.75 * v / s) < 1e-5);  // falls by g 1e-6 s
  ContactRun on(scene, "event", "rk4");
  check_energy(scene, on, 1.0 / 30, 3, 1e-6);
  BOOST_TEST(on.solver_warning() == "");
  BOOST_TEST(on.state().velocity(0).norm() < 1e-9);
  BOOST_TEST(std::abs(on.state().position(0).z() - 0.5 * s) < 1e-9);
}

// Painlevé's rod: where mu > (1 + 3 cos²)/(3 sin cos) its end digs in as it slides, and no force is consistent. The
// known way on is an impact without collision that stops the end at once: its impulse is W⁻¹ (-u).
BOOST_AUTO_TEST_CASE(a_rod_that_slides_too_steeply_is_stopped_by_an_impact_without_collision) {
  const double lean = 1.2, length = 1, radius = 0.01, v = 3;  // rad from level
  Body rod = solid("rod", Capsule{radius, length}, {0, 0, 0.5 * length * std::sin(lean) + radius});
  rod.inertia = Vec3(length * length / 12, length * length / 12, 1e-4).asDiagonal();
  rod.orientation = rotation_by({0, 0.5 * std::numbers::pi - lean, 0});
  rod.velocity = {-v, 0, 0};
  const Scene scene = on_floor({rod}, {0, 1.6});
  ContactRun run(scene, "event", "rk4");
  run.step(1e-5);
  BOOST_TEST(run.solver_warning() == "");
  // About the end that stops, at -r from the centre: (I + m r²) w = m r x v.
  const Vec3 r(0.5 * length * std::cos(lean), 0, 0.5 * length * std::sin(lean) + radius);
  const double w = r.cross(rod.velocity).y() / (length * length / 12 + r.squaredNorm());
  BOOST_TEST(std::abs(run.state().angular_velocity(0).y() - w) < 1e-3);  // gravity turns it by g/L 1e-5 s
  check_energy(scene, run, 1.0 / 100, 2, 1e-6);
}

BOOST_AUTO_TEST_CASE(three_dominoes_fall) {
  std::vector<Body> dominoes;
  for (int i = 0; i < 3; ++i) dominoes.push_back(solid("domino", Box{{0.2, 0.5, 1}}, {0.6 * i, 0, 0.5}));
  dominoes[0].angular_velocity = {0, 1.2, 0}, dominoes[0].velocity = {0.6, 0, 0.12};
  const Scene scene = on_floor(dominoes, {0, 0.5});
  ContactRun run(scene, "event", "rk4");
  // Until the last strikes the floor; what rises is the error of a step.
  check_energy(scene, run, 1.0 / 30, 1.5, 1e-7);
  BOOST_TEST(run.solver_warning() == "");
  for (std::size_t i = 0; i < 3; ++i) BOOST_TEST(angle_between(run.state().orientation(i), Quat::Identity()) > 1);
}

BOOST_AUTO_TEST_CASE(a_box_on_the_verge_of_sliding_slides_straight) {
  const double theta = std::atan(0.5);
  const Vec3 gravity = kG * Vec3(std::sin(theta), 0, -std::cos(theta));
  ContactRun run(on_floor({solid("box", Box{{0.4, 0.4, 0.2}}, {0, 0, 0.1})}, {0, 0.49}, gravity), "event", "rk4");
  run.run(1.0 / 30, 60);
  // Roundings of 1e-17 m/s across the slope are damped, not grown.
  BOOST_TEST(std::abs(run.state().position(0).y()) < 1e-12);
  BOOST_TEST(run.state().angular_velocity(0).norm() < 1e-12);
}

// A slip that begins slowly limits the steps for long. That must not count as events that crowd.
BOOST_AUTO_TEST_CASE(boxes_on_both_sides_of_the_threshold_slide_or_stick_without_crowding) {
  for (const auto& [slope, share] : {std::pair(0.2, 0.8), {0.5, 0.9}, {1.0, 0.8}, {1.7, 0.8}, {1.7, 0.999}}) {
    const BoxesOnSlope boxes(slope, share);
    for (const auto& [length, time, mirrored] :
         {std::tuple(1.0, 1.0, false), {10.0, 1.0, false}, {0.1, 0.3, true}, {1.0, 4.0, true}}) {
      Equivalence how;
      how.length = length, how.time = time, how.is_mirrored = mirrored;
      ContactRun run(equivalent(boxes.scene, how), "event", mirrored ? "rk4" : "velocity-verlet");
      run.run(time / 30, 30);
      BodyTable seen(7);
      to_original(how, run.state(), seen.columns());
      BOOST_TEST_CONTEXT("tan " << slope << ", share " << share << ", length " << length << ", time " << time) {
        BOOST_TEST(!run.reduced_order());
        // A slip below 1e-7 m/s counts as rest: 3.3e-9 m in the longest step, and three of them.
        for (int i = 0; i < 6; ++i)
          BOOST_TEST(std::abs(std::as_const(seen).columns().position(i).x() - boxes.due(i)) < 1e-8, i);
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
