// The worst instant of each metric: value, time, body, component, and both values, on runs with one error larger than
// the others. A report quotes these; a number alone would not reveal a wrong body.
#include <fmt/format.h>
#include <boost/test/unit_test.hpp>

#include "cases/metrics/measures/ensembles.h"
#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_worst_instants)

namespace {

// Three free bodies at rest, without forces, at 0, 1, 2, 3 s; the truth is good up to 2 s, and the run is its own twin.
struct Resting {
  Scene scene;
  Trajectory trajectory{1, {}};
  TruthSamples truth;
  TwinRun twin;

  Resting() {
    scene.bodies = {test::body("a", 1, {1, 1, 1}, {1, 2, 3}), test::body("b", 2, {1, 2, 3}),
                    test::body("c", 3, {1, 1, 1}, {-1, 0, 0})};
    truth.error = {0, 1e-9, 1e-6, 1e-3};  // 1e-6 is just good enough
    truth.largest_kinetic_energy = 4;
    for (int n = 0; n < 4; ++n) {
      BodyTable bodies(3);
      for (int i = 0; i < 3; ++i)
        bodies.columns().set_body(i, {scene.bodies[i].position, Quat::Identity(), Vec3::Zero(), Vec3::Zero()});
      trajectory.samples.push_back({static_cast<double>(n), bodies});
      truth.bodies.push_back(bodies);
    }
    twin = {trajectory, {0, 0, 0, 0}, {0, 0, 0, 0}};
  }
  MutableBodyColumns at(int n) { return trajectory.samples[n].bodies.columns(); }
  Measurement measure(const std::string& metric) const {
    const MetricResult result = test::measured(metric, {scene, trajectory, &truth, 0, &twin});
    BOOST_TEST_REQUIRE(result.measurement.has_value(), metric << ": " << result.not_applicable);
    return *result.measurement;
  }
};

// "0.5 at 1 s of 1: position.y -0.4, not 0; until 2 s, 3 samples": to twelve digits, roundings have four more.
std::string said_of(const Measurement& m) {
  const auto plain = [](double x) { return std::abs(x) < 1e-15 ? 0.0 : x; };
  return fmt::format("{:.12g} at {:.12g} s of {}: {} {:.12g}, not {:.12g}; until {:.12g} s, {} samples", plain(m.value),
                     m.worst.time, m.worst.body, m.worst.component, plain(m.worst.found), plain(m.worst.expected),
                     m.compared_until, m.series.size());
}

Scene ball_over_ground(double height, double restitution, double friction) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::plane(), test::on_its_own("ball", Sphere{0.5}, 2, {0, 0, 0.5 + height})};
  scene.contact_default = {restitution, friction};
  return scene;
}

// The second body of a scene whose others stand.
Trajectory ball_run(const Scene& scene, const std::function<Vec3(double)>& place, double dt, int steps) {
  Trajectory run{dt, {}};
  for (int n = 0; n <= steps; ++n) {
    BodyTable table(scene.bodies.size());
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      table.columns().set_body(i, {scene.bodies[i].position, Quat::Identity(), Vec3::Zero(), Vec3::Zero()});
    table.columns().set_position(1, place(n * dt));
    run.samples.push_back({n * dt, table});
  }
  return run;
}

}  // namespace

BOOST_AUTO_TEST_CASE(places_and_turns_name_the_body_and_the_coordinate_furthest_off) {
  Resting made;
  made.at(1).set_position(1, {0.3, -0.4, 0});  // 0.5 m
  made.at(1).set_position(2, {-1, 0, 0.45});
  made.at(2).set_position(2, {-1.1, 0, 0});
  made.at(3).set_position(0, {100, 0, 0});  // after the truth is no longer good enough
  const Quat turned = rotation_by({0, 0.25, 0});
  made.at(1).set_orientation(1, rotation_by({0, 0, 0.1}));
  made.at(2).set_orientation(2, turned), made.at(2).set_orientation(0, rotation_by({0.2, 0, 0}));
  for (const std::string part : {"position_error", "unexplained_error"})
    BOOST_TEST(said_of(made.measure(part)) == "0.5 at 1 s of 1: position.y -0.4, not 0; until 2 s, 3 samples");
  for (const std::string part : {"orientation_error", "unexplained_rotation"})
    BOOST_TEST(said_of(made.measure(part)) == "0.25 at 2 s of 2: orientation 0.25, not 0; until 2 s, 3 samples");
  BOOST_TEST(made.measure("position_error").series[2] == 0.1, boost::test_tools::tolerance(1e-14));
  BOOST_TEST(made.measure("unexplained_error").series[2] == 0.1, boost::test_tools::tolerance(1e-14));
}

BOOST_AUTO_TEST_CASE(rates_name_the_body_and_the_component_furthest_off) {
  Resting made;
  made.at(2).set_velocity(0, {0.2, 0, 0}), made.at(2).set_velocity(1, {0, 0.3, -0.4});
  made.at(2).set_velocity(2, {0, 0, 0.45});
  made.at(1).set_angular_velocity(2, {0.6, -0.8, 0}), made.at(1).set_angular_velocity(0, {0, 0, 0.9});
  made.at(3).set_velocity(0, {9, 0, 0}), made.at(3).set_angular_velocity(0, {9, 0, 0});
  for (const std::string part : {"velocity_error", "unexplained_velocity"})
    BOOST_TEST(said_of(made.measure(part)) == "0.5 at 2 s of 1: v.z -0.4, not 0; until 2 s, 3 samples");
  for (const std::string part : {"angular_velocity_error", "unexplained_spin"})
    BOOST_TEST(said_of(made.measure(part)) == "1 at 1 s of 2: w.y -0.8, not 0; until 2 s, 3 samples");
}

BOOST_AUTO_TEST_CASE(where_nothing_is_off_the_first_body_at_the_start_stands_for_all) {
  const Resting made;
  for (const std::string part : {"position_error", "unexplained_error"})
    BOOST_TEST(said_of(made.measure(part)) == "0 at 0 s of 0: position.x 1, not 1; until 2 s, 3 samples");
  for (const std::string part : {"orientation_error", "unexplained_rotation"})
    BOOST_TEST(said_of(made.measure(part)) == "0 at 0 s of 0: orientation 0, not 0; until 2 s, 3 samples");
  for (const std::string part : {"velocity_error", "unexplained_velocity"})
    BOOST_TEST(said_of(made.measure(part)) == "0 at 0 s of 0: v.x 0, not 0; until 2 s, 3 samples");
  BOOST_TEST(said_of(made.measure("orthonormality_error")) == "0 at 0 s of 0: RᵀR - I 0, not 0; until 3 s, 4 samples");
  BOOST_TEST(said_of(made.measure("energy_drift")) == "0 at 0 s of -1: energy 0, not 0; until 3 s, 4 samples");
}

BOOST_AUTO_TEST_CASE(a_twin_counts_up_to_its_own_roundings_and_its_own_end) {
  Resting made;
  // 1e-10 of the 3.74 m and of one radian.
  made.twin.position_rounding = {0, 3e-10, 4e-10, 4e-10};
  made.twin.orientation_rounding = {0, 0.9e-10, 0.9e-10, 1.1e-10};
  BOOST_TEST(made.measure("unexplained_error").compared_until == 1);
  BOOST_TEST(made.measure("unexplained_rotation").compared_until == 2);
  // Velocities hang on both.
  BOOST_TEST(made.measure("unexplained_velocity").compared_until == 1);
  made.twin.position_rounding = {0, 0, 0, 0}, made.twin.orientation_rounding = {0, 0.9e-10, 1.1e-10, 1.1e-10};
  BOOST_TEST(made.measure("unexplained_spin").compared_until == 1);
  // A twin that blew up before the run.
  made.twin.trajectory.samples.resize(2), made.twin.position_rounding.resize(2);
  BOOST_TEST(made.measure("unexplained_error").compared_until == 1);
}

BOOST_AUTO_TEST_CASE(energies_and_momenta_are_the_systems) {
  Resting made;
  made.at(2).set_velocity(1, {0, 1, 0});  // 2 kg: 1 J of the 4 in play, 2 kg m/s
  made.at(1).set_velocity(2, {0, 0, -0.5});
  for (const std::string part : {"energy_drift", "energy_drift_synchronised"})
    BOOST_TEST(said_of(made.measure(part)) == "0.25 at 2 s of -1: energy 1, not 0; until 3 s, 4 samples");
  BOOST_TEST(said_of(made.measure("energy_gain")) == "0.25 at 2 s of -1: energy 1, not 0; until 3 s, 4 samples");
  BOOST_TEST(said_of(made.measure("linear_momentum_drift")) == "2 at 2 s of -1: P.y 2, not 0; until 3 s, 4 samples");
  made.at(2).set_angular_velocity(1, {0, 5, 0});
  // About the centre of mass, (-1/3, 1/3, 1/2): (1/3, -1/3, -1/2) x (0, 2, 0) = (1, 0, 2/3), and I w = (0, 10, 0).
  BOOST_TEST(said_of(made.measure("angular_momentum_drift")) ==
             fmt::format("{:.12g} at 2 s of -1: L.y 10, not 0; until 3 s, 4 samples", std::sqrt(1 + 4.0 / 9 + 100)));
}

// With 3 kg held fixed beside them, the momentum is that of the others, and forces on it give none.
BOOST_AUTO_TEST_CASE(fixed_bodies_have_no_part_in_momenta) {
  Resting made;
  made.scene.bodies[2].fixed = true;
  made.at(1).set_velocity(2, {1, 1, 1});
  TimedForce on_fixed{.body = 2, .force = {1, 2, 3}, .torque = {3, 2, 1}};
  made.scene.forces = {on_fixed};
  BOOST_TEST(made.measure("linear_momentum_drift").value == 0);
  BOOST_TEST(made.measure("angular_momentum_drift").value == 0);
  // About the centre of mass of a and b, (1/3, 2/3, 1): (-1/3, -2/3, -1) x (0, 2, 0) = (2, 0, -2/3).
  made.at(2).set_velocity(1, {0, 1, 0});
  BOOST_TEST(said_of(made.measure("angular_momentum_drift")) ==
             fmt::format("{:.12g} at 2 s of -1: L.x 2, not 0; until 3 s, 4 samples", std::sqrt(4 + 4.0 / 9)));
}

// Gravity gives each kilogram g t; a force from 0.5 s to 2.5 s on the only moving body its own.
BOOST_AUTO_TEST_CASE(what_acts_from_outside_is_expected_of_the_momenta) {
  Resting made;
  made.scene.bodies[1].fixed = made.scene.bodies[2].fixed = true;
  made.scene.gravity = {0, 0, -2};
  made.scene.forces = {{.body = 0, .force = {4, 0, 0}, .torque = {0, 6, 0}, .from = 0.5, .until = 2.5}};
  BOOST_TEST(said_of(made.measure("linear_momentum_drift")) ==
             "10 at 3 s of -1: P.x 0, not 8; until 3 s, 4 samples");  // (8, 0, -6)
  BOOST_TEST(said_of(made.measure("angular_momentum_drift")) == "12 at 3 s of -1: L.y 0, not 12; until 3 s, 4 samples");
  made.scene.forces[0].from = -1;  // the run begins at 0
  BOOST_TEST(said_of(made.measure("angular_momentum_drift")) == "15 at 3 s of -1: L.y 0, not 15; until 3 s, 4 samples");
  // At the centre of one of two bodies it has an arm about the centre of both: only a truth knows which.
  made.scene.bodies[1].fixed = false;
  BOOST_TEST(said_of(made.measure("angular_momentum_drift")) == "0 at 0 s of -1: L.x 0, not 0; until 2 s, 3 samples");
}

BOOST_AUTO_TEST_CASE(the_deepest_overlap_names_who_moves_and_what_it_is_in) {
  Scene scene = ball_over_ground(1, 0, 0);
  scene.bodies.push_back(test::on_its_own("other", Sphere{0.5}, 1, {0, 0, 3}));
  const auto dips = [](double t) { return Vec3(0, 0, t == 1 ? 0.3 : t == 2 ? 2.375 : t == 3 ? 0.4 : 1.5); };
  const Trajectory run = ball_run(scene, dips, 1, 4);
  const MetricResult deepest = test::measured("penetration", {scene, run, nullptr, 0});
  BOOST_TEST(said_of(*deepest.measurement) == "0.375 at 2 s of 1: gap to 'other' -0.375, not 0; until 4 s, 5 samples");
  scene.bodies[2].fixed = true;
  BOOST_TEST(test::measured("penetration", {scene, run, nullptr, 0}).measurement->worst.component == "gap to 'other'");
  scene.bodies[2].collides = false;
  BOOST_TEST(said_of(*test::measured("penetration", {scene, run, nullptr, 0}).measurement) ==
             "0.2 at 1 s of 1: gap to 'ground' -0.2, not 0; until 4 s, 5 samples");
}

BOOST_AUTO_TEST_CASE(a_structure_that_creeps_and_falls_names_its_body) {
  const Scene scene = ball_over_ground(0, 0, 0.5);
  const auto creeps = [](double t) { return Vec3(t == 3 ? 0.2 : 0.1 * t, 0, 0.5); };
  const Trajectory run = ball_run(scene, creeps, 1, 4);
  const JudgedRun judged{scene, run, nullptr, 0};
  BOOST_TEST(said_of(*test::measured("creep", judged).measurement) ==
             "0.4 at 4 s of 1: displacement 0.4, not 0; until 4 s, 5 samples");
  // Half its radius is 0.25 m.
  BOOST_TEST(said_of(*test::measured("collapse_time", judged).measurement) ==
             "4 at 4 s of 1: displacement 0.4, not 0; until 4 s, 0 samples");
  const Trajectory stands = ball_run(
      scene, [](double t) { return Vec3(t > 0 ? 0.25 : 0, 0, 0.5); }, 1, 4);
  BOOST_TEST(said_of(*test::measured("collapse_time", {scene, stands, nullptr, 0}).measurement) ==
             "4 at 4 s of -1: displacement 0, not 0; until 4 s, 0 samples");
}

BOOST_AUTO_TEST_CASE(impacts_name_the_body_that_moves_and_both_values) {
  const Scene scene = ball_over_ground(5, 0.6, 0);
  const auto truth = make_truth("bounce", scene, 3);
  Trajectory run = test::played(*truth, scene, 0.01, 270);
  const TruthSamples samples = test::sampled(*truth, run, scene, 100);
  // Hits after 1 s at 10 m/s, after 1.2 s more at 6; the second time it leaves at 3 instead of 3.6 m/s.
  for (Sample& sample : run.samples) {
    const double since = sample.time - 2.2;
    if (since < -1e-9) continue;
    sample.bodies.columns().set_position(1, {0, 0, 0.5 + 3 * since - 5 * since * since});
    sample.bodies.columns().set_velocity(1, {0, 0, 3 - 10 * since});
  }
  const JudgedRun judged{scene, run, &samples, 0};
  const Measurement m = *test::measured("restitution_error", judged).measurement;
  BOOST_TEST(m.value == 0.1, boost::test_tools::tolerance(1e-6));  // differences over 1e-6 s
  BOOST_TEST(m.worst.time == 2.2, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(m.worst.found == 0.5, boost::test_tools::tolerance(1e-6));
  BOOST_TEST(m.worst.expected == 0.6);
  BOOST_TEST(m.worst.body == 1);
  BOOST_TEST(m.worst.component == "restitution");
  BOOST_TEST(m.compared_until == 2.7, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(impact_times_are_compared_one_by_one_up_to_the_truths_horizon) {
  const Scene scene = ball_over_ground(5, 0.6, 0);
  const auto truth = make_truth("bounce", scene, 3);
  Trajectory run = test::played(*truth, scene, 0.01, 270);
  TruthSamples samples = test::sampled(*truth, run, scene, 100);
  // The delay is 0.03 s from 1.5 s on.
  for (std::size_t n = 150; n < run.samples.size(); ++n) run.samples[n].bodies = samples.bodies[n - 3];
  const Trajectory itself = test::played(*truth, scene, 0.01, 270);
  const Measurement none = *test::measured("impact_time_error", {scene, itself, &samples, 0}).measurement;
  BOOST_TEST(none.value == 0);
  BOOST_TEST(none.worst.component == "impact");
  const JudgedRun judged{scene, run, &samples, 0};
  const Measurement m = *test::measured("impact_time_error", judged).measurement;
  BOOST_TEST(m.value == 0.03, boost::test_tools::tolerance(1e-6));
  BOOST_TEST(m.worst.time == 2.2, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(m.worst.found == 2.23, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(m.worst.expected == 2.2, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(m.worst.body == 1);
  BOOST_TEST(m.worst.component == "impact");
  BOOST_TEST(m.compared_until == 2.7, boost::test_tools::tolerance(1e-12));
  for (std::size_t n = 201; n < samples.error.size(); ++n) samples.error[n] = 1;
  const Measurement first = *test::measured("impact_time_error", judged).measurement;
  BOOST_TEST(first.value < 1e-9);
  BOOST_TEST(first.compared_until == 2, boost::test_tools::tolerance(1e-12));
}

// One that misses the first is late by all that is left of 1.7 s; one that has it and no other is late by nothing.
BOOST_AUTO_TEST_CASE(an_impact_that_never_comes_is_late_by_the_rest_if_it_is_the_first) {
  const Scene scene = ball_over_ground(5, 0.6, 0);
  const auto truth = make_truth("bounce", scene, 3);
  Trajectory run = test::played(*truth, scene, 0.01, 270);
  const TruthSamples samples = test::sampled(*truth, run, scene, 100);
  const auto error = [&](double stops) {
    for (Sample& sample : run.samples) {
      if (sample.time < stops) continue;
      sample.bodies.columns().set_position(1, {0, 0, 9}), sample.bodies.columns().set_velocity(1, Vec3::Zero());
    }
    return *test::measured("impact_time_error", {scene, run, &samples, 0}).measurement;
  };
  BOOST_TEST(error(1.5).value < 1e-9);
  const Measurement none = error(0.5);
  BOOST_TEST(none.value == 1.7, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(none.worst.found == 2.7, boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(single_numbers_say_what_they_are_of) {
  const Resting made;
  JudgedRun run{made.scene, made.trajectory, nullptr, 0};
  run.cpu_seconds = 0.6, run.survived = 2.5, run.duration = 3;
  BOOST_TEST(said_of(*test::measured("cost", run).measurement) ==
             "0.2 at 3 s of -1: CPU time 0.6, not 0; until 3 s, 0 samples");
  BOOST_TEST(said_of(*test::measured("survival", run).measurement) ==
             "2.5 at 2.5 s of -1: time 2.5, not 3; until 2.5 s, 0 samples");
  BOOST_TEST(test::measured("ensemble_distance", run).not_applicable == "the case asks for no ensemble");
  Ensembles ensembles{{0.25, 0.125}, ""};
  run.ensembles = &ensembles;
  BOOST_TEST(said_of(*test::measured("ensemble_distance", run).measurement) ==
             "0.25 at 3 s of -1: final places 0.25, not 0; until 3 s, 0 samples");
  BOOST_TEST(said_of(*test::measured("ensemble_p_value", run).measurement) ==
             "0.125 at 3 s of -1: final places 0.125, not 1; until 3 s, 0 samples");
  ensembles.flaw = "two of them blew up";
  BOOST_TEST(test::measured("ensemble_p_value", run).not_applicable == "two of them blew up");
  Trajectory start{1, {made.trajectory.samples[0]}};
  BOOST_TEST(test::measured("cost", {made.scene, start, nullptr, 0}).not_applicable == "the run has no finite step");
}

// Three boxes pushed off at 5 m/s in three directions slide 25/9.81 m each; the run's stop after 1.1, 0.8 and 0.95 of
// it.
BOOST_AUTO_TEST_CASE(stops_name_the_body_whose_distance_is_furthest_off) {
  Scene scene = test::on_slope(Box{{0.4, 0.4, 0.2}}, 0, 0.5, 5);
  for (const Vec3& velocity : {Vec3(0, 5, 0), Vec3(-5, 0, 0)}) {
    scene.bodies.push_back(scene.bodies[0]);
    scene.bodies.back().name += velocity.y() > 0 ? "y" : "x";
    scene.bodies.back().position.y() = velocity.y() > 0 ? 3 : -3, scene.bodies.back().velocity = velocity;
  }
  const auto truth = make_truth("sliding", scene, 3);
  Trajectory run = test::played(*truth, scene, 0.01, 300);
  const TruthSamples samples = test::sampled(*truth, run, scene, 25);
  const double stop = 25 / 9.81;
  const auto columns = run.samples.back().bodies.columns();
  columns.set_position(0, {1.1 * stop, 0, 0.1}), columns.set_position(2, {0, 3 + 0.8 * stop, 0.1});
  columns.set_position(3, {-0.95 * stop, -3, 0.1});
  const JudgedRun judged{scene, run, &samples, 0};
  const auto expected = [&](double value) {
    return fmt::format("{:.12g} at 3 s of 2: distance {:.12g}, not {:.12g}; until 3 s, 0 samples", value, 0.8 * stop,
                       stop);
  };
  BOOST_TEST(said_of(*test::measured("stop_distance_error", judged).measurement) == expected(0.2));
  BOOST_TEST(said_of(*test::measured("friction_anisotropy", judged).measurement) == expected(0.3));
  columns.set_position(0, {1.3 * stop, 0, 0.1});
  BOOST_TEST(test::measured("friction_anisotropy", judged).measurement->worst.body == 0);
  // Fixed ones do not count, nor can one alone be compared.
  scene.bodies[2].fixed = scene.bodies[3].fixed = true;
  BOOST_TEST(test::measured("friction_anisotropy", judged).not_applicable.find("one body stops") == 0);
  BOOST_TEST(test::measured("stop_distance_error", judged).measurement->worst.body == 0);
}

// Half a micrometre, at an end that the truth knows to nine tenths of one.
BOOST_AUTO_TEST_CASE(a_stop_that_the_truth_cannot_tell_from_none_is_none) {
  const Scene scene = test::on_slope(Box{{0.4, 0.4, 0.2}}, 0, 0.5, 5);
  const auto creeps = [](double t) { return BodyState{{t * 5e-7, 0, 0.1}, Quat::Identity(), {0, 0, 0}, {0, 0, 0}}; };
  const test::StatedTruth truth(creeps);
  const Trajectory run = test::played(truth, scene, 1, 1);
  TruthSamples samples = test::sampled(truth, run, scene, 1);
  BOOST_TEST(test::measured("stop_distance_error", {scene, run, &samples, 0}).measurement.has_value());
  const test::StatedTruth rest([&](double) { return creeps(0); });
  const TruthSamples resting = test::sampled(rest, run, scene, 1);
  BOOST_TEST(!test::measured("stop_distance_error", {scene, run, &resting, 0}).measurement.has_value());
  samples.error.back() = 9e-7;
  BOOST_TEST(test::measured("stop_distance_error", {scene, run, &samples, 0}).not_applicable ==
             "no body comes to a stop in truth");
}

// With the square of the speed: 1e-9 of the distance is equal.
BOOST_AUTO_TEST_CASE(directions_are_compared_only_where_their_distances_should_be_the_same) {
  Scene scene = test::on_slope(Box{{0.4, 0.4, 0.2}}, 0, 0.5, 5);
  scene.bodies.push_back(scene.bodies[0]);
  scene.bodies[2].name = "other", scene.bodies[2].position.y() = 3;
  for (const auto& [speed, is_compared] : {std::pair{5.0, true}, {5 * (1 + 0.4e-9), true}, {5 * (1 + 0.7e-9), false}}) {
    scene.bodies[2].velocity = {0, speed, 0};
    const auto truth = make_truth("sliding", scene, 3);
    const Trajectory run = test::played(*truth, scene, 0.01, 300);
    const TruthSamples samples = test::sampled(*truth, run, scene, 25);
    const MetricResult found = test::measured("friction_anisotropy", {scene, run, &samples, 0});
    BOOST_TEST(found.measurement.has_value() == is_compared, speed - 5);
  }
}

BOOST_AUTO_TEST_SUITE_END()
