#include "core/dynamics/model/loads/loads.h"

#include <boost/test/unit_test.hpp>

#include "core/dynamics/model/energy.h"
#include "core/dynamics/model/loads/load_jacobian.h"
#include "core/dynamics/model/system.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_model_loads_loads)

namespace {

BodyTable initial(const Scene& scene) {
  BodyTable table(scene.bodies.size());
  set_initial_state(scene, table.columns());
  return table;
}

// Moves one of a body's six pose coordinates (displacement, rotation vector in W), or of its velocity's.
void move_pose(BodyTable& table, std::size_t i, int k, double h) {
  const MutableBodyColumns c = table.columns();
  if (k < 3)
    c.set_position(i, c.position(i) + h * Vec3::Unit(k));
  else
    c.set_orientation(i, rotation_by(h * Vec3::Unit(k - 3)) * c.orientation(i));
}
void move_velocity(BodyTable& table, std::size_t i, int k, double h) {
  const MutableBodyColumns c = table.columns();
  if (k < 3)
    c.set_velocity(i, c.velocity(i) + h * Vec3::Unit(k));
  else
    c.set_angular_velocity(i, c.angular_velocity(i) + h * Vec3::Unit(k - 3));
}

// The coupled bodies on springs whose stiffness grows.
Scene on_quadratic_springs(double damping) {
  Scene scene = test::coupled_bodies(damping);
  for (Spring& spring : scene.springs) spring.quadratic_stiffness = 0.7 * spring.stiffness;
  return scene;
}

Vec6 wrench_of(const Wrench& w) {
  Vec6 v;
  v << w.force, w.torque;
  return v;
}

}  // namespace

// Without damping and timed forces the wrench is the downhill slope of the energy. Central differences with h = 1e-5
// are right to h² times the third derivative, about 1e-7 here.
BOOST_AUTO_TEST_CASE(springs_and_gravity_are_the_slope_of_the_potential_energy) {
  for (Scene scene : {test::coupled_bodies(0), on_quadratic_springs(0)}) {
    scene.forces.clear();
    const BodyTable start = initial(scene);
    Wrenches wrenches;
    Loads(scene).evaluate_with_gravity(start.columns(), 0, 0, wrenches);
    const double h = 1e-5;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      for (int k = 0; k < 6; ++k) {
        BodyTable up = start, down = start;
        move_pose(up, i, k, h), move_pose(down, i, k, -h);
        const double slope =
            (potential_energy(scene, up.columns()) - potential_energy(scene, down.columns())) / (2 * h);
        BOOST_TEST(std::abs(wrench_of(wrenches[i])[k] + slope) < 1e-6, "body " << i << " coordinate " << k);
      }
    }
  }
}

// With stiffness 10 and 4 more for each metre, an extension of 0.5 m pulls with 6 N, and -0.5 m pushes with as much.
BOOST_AUTO_TEST_CASE(a_quadratic_stiffness_adds_to_the_force_on_either_side) {
  for (const double x : {0.5, -0.5}) {
    Scene scene;
    scene.bodies = {test::body("mass", 1, {1, 1, 1}, {2 + x, 0, 0})};
    scene.springs = {test::spring(kWorld, {0, 0, 0}, 0, {0, 0, 0}, 10, 2)};
    scene.springs[0].quadratic_stiffness = 4;
    Wrenches w;
    Loads(scene).evaluate(initial(scene).columns(), 0, 0, w);
    BOOST_TEST(std::abs(w[0].force.x() + std::copysign(6.0, x)) < 1e-14);
    BOOST_TEST(std::abs(scene.extension_at_start(scene.springs[0]) - x) < 1e-15);
    BOOST_TEST(std::abs(stiffness_at(scene.springs[0], x) - 14) < 1e-14);  // 10 + 2 * 4 * 0.5
  }
}

BOOST_AUTO_TEST_CASE(a_spring_between_bodies_keeps_both_momenta) {
  Scene scene = test::coupled_bodies(5);
  scene.forces.clear();
  scene.springs = {scene.springs[1]};
  const BodyTable start = initial(scene);
  Wrenches w;
  Loads(scene).evaluate(start.columns(), 0, 0, w);
  BOOST_TEST((w[0].force + w[1].force).norm() < 1e-13);
  const Vec3 moment = start.columns().position(0).cross(w[0].force) + w[0].torque +
                      start.columns().position(1).cross(w[1].force) + w[1].torque;
  BOOST_TEST(moment.norm() < 1e-13);
}

BOOST_AUTO_TEST_CASE(damping_acts_along_the_line_and_against_the_motion) {
  Scene scene;
  scene.bodies = {test::body("mass", 1, {1, 1, 1}, {2, 0, 0})};
  scene.bodies[0].velocity = {3, 4, 0};
  scene.springs = {test::spring(kWorld, {0, 0, 0}, 0, {0, 0, 0}, 10, 2, 5)};
  Wrenches w;
  Loads(scene).evaluate(initial(scene).columns(), 0, 0, w);
  BOOST_TEST((w[0].force - Vec3(-15, 0, 0)).norm() < 1e-14);
}

BOOST_AUTO_TEST_CASE(a_timed_force_has_its_impulse_whatever_the_step) {
  Scene scene;
  scene.bodies = {test::body("mass", 1, {1, 1, 1})};
  TimedForce force;
  force.body = 0, force.force = {6, 0, 0}, force.torque = {0, 0, 2}, force.from = 0.11, force.until = 0.47;
  scene.forces = {force};
  for (const double dt : {1.0 / 30, 0.1, 1.0, 0.003}) {
    Vec3 impulse = Vec3::Zero(), twist = Vec3::Zero();
    for (int n = 0; n * dt < 1; ++n) {
      Wrenches w;
      Loads(scene).evaluate(initial(scene).columns(), n * dt, dt, w);
      impulse += dt * w[0].force, twist += dt * w[0].torque;
    }
    BOOST_TEST((impulse - Vec3(6 * 0.36, 0, 0)).norm() < 1e-13, "dt = " << dt);
    BOOST_TEST((twist - Vec3(0, 0, 2 * 0.36)).norm() < 1e-13, "dt = " << dt);
  }
}

BOOST_AUTO_TEST_CASE(a_spring_of_no_length_pulls_nowhere) {
  Scene scene;
  scene.bodies = {test::body("mass", 1, {1, 1, 1})};
  scene.springs = {test::spring(kWorld, {0, 0, 0}, 0, {0, 0, 0}, 10, 1, 1)};
  Wrenches w;
  Loads(scene).evaluate(initial(scene).columns(), 0, 0, w);
  BOOST_TEST(w[0].force.norm() == 0);
}

// Central differences with h = 1e-5: error about h² times the third derivative, below 1e-6 of entries up to 1e2.
BOOST_AUTO_TEST_CASE(the_load_jacobian_is_the_derivative_of_the_wrenches) {
  for (Scene scene : {test::coupled_bodies(7), on_quadratic_springs(7)}) {
    scene.bodies[0].velocity = {0.3, -1, 0.2};
    const Loads loads(scene);
    const BodyTable start = initial(scene);
    const std::size_t n = scene.bodies.size();
    std::vector<Mat6> by_pose(n * n, Mat6::Zero()), by_velocity(n * n, Mat6::Zero());
    visit_load_jacobian(loads, start.columns(), 0, 0.1, [&](const WrenchDerivative& d) {
      by_pose[d.row * n + d.column] += d.by_pose;
      by_velocity[d.row * n + d.column] += d.by_velocity;
    });
    const double h = 1e-5;
    for (const auto& [move, blocks] : {std::pair(&move_pose, &by_pose), std::pair(&move_velocity, &by_velocity)}) {
      for (std::size_t j = 0; j < n; ++j) {
        for (int k = 0; k < 6; ++k) {
          BodyTable up = start, down = start;
          move(up, j, k, h), move(down, j, k, -h);
          Wrenches after, before;
          loads.evaluate(up.columns(), 0, 0.1, after), loads.evaluate(down.columns(), 0, 0.1, before);
          for (std::size_t i = 0; i < n; ++i) {
            const Vec6 slope = (wrench_of(after[i]) - wrench_of(before[i])) / (2 * h);
            BOOST_TEST((slope - (*blocks)[i * n + j].col(k)).norm() < 1e-5, "wrench " << i << " by " << j << "." << k);
          }
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_step_is_divided_where_a_timed_force_begins_or_ends) {
  Scene scene;
  scene.bodies = {test::body("ball", 1, {1, 1, 1})};
  TimedForce first, second;
  first.body = second.body = 0;
  first.from = 0.25, first.until = 0.75;
  second.from = 0.5;  // for ever
  scene.forces = {first, second};
  const Loads loads(scene);
  const auto parts = [&](double t, double dt) {
    std::vector<double> found;
    loads.for_each_smooth_part(t, dt, [&](double from, double length) {
      found.push_back(from);
      found.push_back(length);
    });
    return found;
  };
  BOOST_TEST(parts(0, 1) == std::vector<double>({0, 0.25, 0.25, 0.25, 0.5, 0.25, 0.75, 0.25}));
  BOOST_TEST(parts(0.25, 0.25) == std::vector<double>({0.25, 0.25}));  // switches at the ends divide nothing
  BOOST_TEST(parts(0.6, -0.2) == std::vector<double>({0.6, 0.5 - 0.6, 0.5, 0.6 - 0.2 - 0.5}));  // backwards
  BOOST_TEST(parts(3, 0.1) == std::vector<double>({3, 0.1}));  // the very dt, not what is left of it in t + dt
}

BOOST_AUTO_TEST_SUITE_END()
