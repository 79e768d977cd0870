// Every method of the core is held to the facts that its own row states.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <utility>

#include "core/dynamics/energy.h"
#include "core/dynamics/integrators/integrator.h"
#include "tests/scenes.h"

using namespace rigor;

namespace {

struct Method {
  const Integrator* integrator;
  const OrientationUpdate* orientation;  // null where the method has one way only
  std::string name() const { return integrator->name + (orientation ? "," + orientation->name : ""); }
};

std::vector<Method> every_method() {
  std::vector<Method> methods;
  for (const Integrator& row : integrators()) {
    if (row.default_orientation.empty()) {
      methods.push_back({&row, nullptr});
      continue;
    }
    for (const OrientationUpdate& update : orientation_updates()) methods.push_back({&row, &update});
  }
  return methods;
}

class Run {
 public:
  Run(const Scene& scene, const Method& method)
      : system_(scene), state_(scene.bodies.size(), method.orientation && method.orientation->keeps_matrix) {
    set_initial_state(scene, state_.columns());
    stepper_ = method.integrator->make({system_, nullptr, method.orientation});
  }
  void steps(double dt, int count) {
    for (int k = 0; k < count; ++k, ++n_) {
      stepper_->step(state_.columns(), n_ * dt, dt);
      if (complaint_.empty()) complaint_ = stepper_->complaint();
    }
  }
  BodyColumns bodies() const { return state_.columns(); }
  const std::string& complaint() const { return complaint_; }

 private:
  System system_;
  BodyTable state_;
  std::unique_ptr<Stepper> stepper_;
  int n_ = 0;
  std::string complaint_;
};

double distance(BodyColumns a, BodyColumns b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest =
        std::max({largest, (a.position(i) - b.position(i)).norm(), angle_between(a.orientation(i), b.orientation(i)),
                  (a.velocity(i) - b.velocity(i)).norm(), (a.angular_velocity(i) - b.angular_velocity(i)).norm()});
  }
  return largest;
}

// The classical method at a step so small that its error is far below those it judges.
BodyTable accurate(const Scene& scene, double duration) {
  Run run(scene, {&integrator("rk4"), nullptr});
  run.steps(duration / 20000, 20000);
  return BodyTable(run.bodies());
}

// log2 of the ratio of the errors at dt and dt/2.
double observed_order(const Scene& scene, const Method& method, double duration, int steps) {
  const BodyTable truth = accurate(scene, duration);
  double error[2];
  for (int k = 0; k < 2; ++k) {
    Run run(scene, method);
    run.steps(duration / (steps << k), steps << k);
    error[k] = distance(run.bodies(), truth.columns());
    BOOST_TEST_MESSAGE(method.name() << " in " << (steps << k) << " steps: " << error[k]);
  }
  return std::log2(error[0] / error[1]);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(core_dynamics_integrators)

BOOST_AUTO_TEST_CASE(rows_are_alphabetical_and_unique) {
  const auto by_name = [](const Integrator& a, const Integrator& b) { return a.name < b.name; };
  BOOST_TEST(std::is_sorted(integrators().begin(), integrators().end(), by_name));
  BOOST_TEST((std::adjacent_find(integrators().begin(), integrators().end(), [](const auto& a, const auto& b) {
                return a.name == b.name;
              }) == integrators().end()));
}

// Tolerance 0.25: at these steps the next term of the error series is a few per cent of the leading one.
BOOST_AUTO_TEST_CASE(each_converges_at_its_stated_order) {
  const std::pair<const char*, Scene> scenes[] = {{"a free body of three moments", test::tumbling_body()},
                                                  {"coupled bodies without damping", test::coupled_bodies(0)},
                                                  {"coupled bodies with damping", test::coupled_bodies(3)}};
  for (const auto& [what, scene] : scenes) {
    for (const Method& method : every_method()) {
      const int steps = method.integrator->order >= 4 ? 50 : 1600;
      const double order = observed_order(scene, method, 1.0, steps);
      BOOST_TEST(std::abs(order - method.integrator->order) < 0.25,
                 method.name() << " on " << what << ": observed order " << order);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_symplectic_method_does_not_gain_or_lose_energy_over_many_periods) {
  // A body of equal moments on a spring through its centre: no gyroscopic term, so that every method stated to be
  // symplectic is so as a whole. 200 periods; a first- or second-order drift per step would have added up.
  Scene scene;
  scene.bodies = {test::body("ball", 1, {1, 1, 1}, {1.5, 0, 0})};
  scene.bodies[0].velocity = {0, 0.4, 0};
  scene.springs = {test::spring(kWorld, {0, 0, 0}, 0, {0, 0, 0}, 1, 1)};
  const double dt = 0.1;
  for (const Method& method : every_method()) {
    Run run(scene, method);
    const double start = energy(scene, run.bodies());
    double first = 0, last = 0;  // mean energies over the first and the last ten periods
    const int steps = 12566, part = 628;
    for (int n = 0; n < steps; ++n) {
      run.steps(dt, 1);
      if (n < part) first += energy(scene, run.bodies()) / part;
      if (n >= steps - part) last += energy(scene, run.bodies()) / part;
    }
    const double drift = std::abs(last - first) / start;
    if (method.integrator->symplectic) {
      BOOST_TEST(drift < 1e-3, method.name() << ": " << drift);  // what the oscillation leaves in a mean of ten periods
    } else if (method.integrator->order == 1 && method.integrator->twin_of.empty()) {  // a twin's loss is in its spin
      BOOST_TEST(!(drift < 1), method.name() << " is stated not to be symplectic, yet keeps the energy: " << drift);
    }
  }
}

BOOST_AUTO_TEST_CASE(velocity_verlet_keeps_angular_momentum_and_has_no_phase_error_for_equal_moments) {
  const Method verlet{&integrator("velocity-verlet"), nullptr};
  const Scene tumbling = test::tumbling_body();
  Run run(tumbling, verlet);
  const Vec3 before = angular_momentum(tumbling, run.bodies(), run.bodies().position(0));
  run.steps(1.0 / 30, 3000);
  const Vec3 after = angular_momentum(tumbling, run.bodies(), run.bodies().position(0));
  BOOST_TEST((after - before).norm() / before.norm() < 1e-12);  // 3000 roundings of 1e-16, some in each step

  for (const Vec3& moments : {Vec3(2, 2, 2), Vec3(1, 2, 2), Vec3(2, 2, 1), Vec3(2, 1, 2)}) {
    const Scene scene = test::tumbling_body(moments);
    Run symmetric(scene, verlet);
    symmetric.steps(0.5, 20);
    const BodyTable truth = accurate(scene, 10);
    // The classical method's own error at 5e-4 s is below 1e-11; a phase error of the splitting would be about 0.1.
    BOOST_TEST(angle_between(symmetric.bodies().orientation(0), truth.columns().orientation(0)) < 1e-10,
               "moments " << moments.transpose());
  }
}

BOOST_AUTO_TEST_CASE(implicit_midpoint_is_solved_to_rounding_and_says_when_it_is_not) {
  const Method midpoint{&integrator("implicit-midpoint"), nullptr};
  // Symmetric: a step forward and a step back return to the start, if the equations were solved to rounding.
  const Scene scene = test::coupled_bodies(0);
  Run run(scene, midpoint);
  const BodyTable start(run.bodies());
  run.steps(0.05, 1);
  run.steps(-0.05, 1);
  BOOST_TEST(distance(run.bodies(), start.columns()) < 1e-13);
  BOOST_TEST(run.complaint() == "");

  Run too_coarse(test::fixed_spring(), midpoint);
  too_coarse.steps(0.5, 100);
  BOOST_TEST(too_coarse.complaint().find("did not converge") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_fixed_body_stays_where_it_is) {
  Scene scene = test::coupled_bodies(1);
  scene.bodies[0].fixed = true;
  scene.bodies[0].velocity = {1, 2, 3};
  for (const Method& method : every_method()) {
    Run run(scene, method);
    run.steps(1.0 / 30, 30);
    BOOST_TEST((run.bodies().position(0) - scene.bodies[0].position).norm() == 0, method.name());
    BOOST_TEST(run.bodies().angular_velocity(0).norm() == 0, method.name());
    BOOST_TEST((run.bodies().position(1) - scene.bodies[1].position).norm() > 0.01, method.name());
  }
}

BOOST_AUTO_TEST_SUITE_END()
