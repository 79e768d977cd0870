#include <boost/test/unit_test.hpp>

#include "cases/metrics/measures/energy_in_play.h"
#include "tests/cases/judged.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_energy_drift)

namespace {

Trajectory run_of(const Scene& scene, const std::string& method, double dt, double duration) {
  return simulate(find_engine(engines(), "core"), test::core_method(method), scene, dt, duration).trajectory;
}

// A body without forces, whose speed at 0, 1, 2, ... s is as given.
struct Coasting {
  Scene scene;
  Trajectory trajectory{1, {}};
  explicit Coasting(const std::vector<double>& speeds) {
    scene.bodies = {test::body("a", 2, {1, 1, 1})};
    scene.bodies[0].velocity = {speeds.front(), 0, 0};
    for (const double speed : speeds) {
      BodyTable bodies(1);
      bodies.columns().set_body(0, {Vec3::Zero(), Quat::Identity(), {speed, 0, 0}, Vec3::Zero()});
      trajectory.samples.push_back({static_cast<double>(trajectory.samples.size()), bodies});
    }
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(a_known_change_of_speed_is_a_known_drift) {
  const Coasting made({10, 9, 11, 10});
  const Measurement m = *test::measured("energy_drift", {made.scene, made.trajectory, nullptr, 0}).measurement;
  // m v²/2 with m = 2: 100, 81, 121, 100 J, over the 100 J of the start.
  BOOST_REQUIRE(m.series.size() == 4);
  BOOST_TEST(m.series[1] == 0.19, boost::test_tools::tolerance(1e-13));
  BOOST_TEST(m.value == 0.21, boost::test_tools::tolerance(1e-13));
  BOOST_TEST(m.worst.time == 2);
  BOOST_TEST(m.worst.found == 121);
  BOOST_TEST(m.worst.expected == 100);
}

BOOST_AUTO_TEST_CASE(where_contact_may_lose_energy_only_gains_count) {
  Coasting made({10, 9, 9.5, 5, 5});
  made.scene = test::dropped_sphere(0.5);
  made.scene.gravity.setZero();
  made.scene.bodies[0].mass = 2, made.scene.bodies[0].velocity = {10, 0, 0};
  for (Sample& sample : made.trajectory.samples) {
    const BodyState moving = sample.bodies.columns().body(0);
    sample.bodies.resize(2);
    sample.bodies.columns().set_body(0, moving);
    sample.bodies.columns().set_orientation(1, Quat::Identity());
  }
  const Measurement m = *test::measured("energy_drift", {made.scene, made.trajectory, nullptr, 0}).measurement;
  BOOST_TEST(m.value == (90.25 - 81) / 100, boost::test_tools::tolerance(1e-13));
  BOOST_TEST(m.worst.time == 2);
  // The same with a perfect bounce and no friction: losses count too.
  made.scene.contact_default = {1, 0};
  const Measurement kept = *test::measured("energy_drift", {made.scene, made.trajectory, nullptr, 0}).measurement;
  BOOST_TEST(kept.value == 0.75, boost::test_tools::tolerance(1e-13));
}

BOOST_AUTO_TEST_CASE(what_is_pushed_over_ground_that_brakes_may_gain_what_its_truth_gains) {
  // Gains of a pushed body are its push's, so that they are held against the truth, whatever the contact takes.
  Scene scene = test::dropped_sphere(0.5);
  scene.forces.push_back({.body = 0, .force = Vec3(3, 0, 0)});
  const auto truth = make_truth("bounce", test::dropped_sphere(1), 2);
  const Trajectory run = test::played(*truth, scene, 0.1, 20);
  TruthSamples samples = test::sampled(*truth, run, scene, 100 * 9.8 * 1.37);
  const auto drift = [&] { return test::measured("energy_drift", {scene, run, &samples, 0}).measurement->value; };
  BOOST_TEST(drift() < 1e-12);
  const JudgedRun lagging{scene, run, &samples, 0.5};  // what brakes it is not known, so nothing is brought forward
  BOOST_TEST(test::measured("energy_drift_synchronised", lagging).measurement->value < 1e-12);
  for (std::size_t n = 10; n < samples.bodies.size(); ++n) {
    const auto columns = samples.bodies[n].columns();
    columns.set_position(0, columns.position(0) + Vec3(0, 1.37, 0));  // m g h more than the run has
  }
  BOOST_TEST(drift() == 1, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(!test::measured("energy_drift", {scene, run, nullptr, 0}).not_applicable.empty());
}

BOOST_AUTO_TEST_CASE(the_elastic_bounce_must_keep_its_energy_even_with_friction) {
  // The truth of the elastic drop keeps it, so a run that loses some is found out.
  const Scene scene = test::dropped_sphere(1);
  const auto truth = make_truth("bounce", scene, 2);
  Trajectory lossy = test::played(*truth, scene, 0.1, 20);
  lossy.samples[15].bodies.columns().set_position(0, {0, 0.1, 0});
  lossy.samples[15].bodies.columns().set_velocity(0, Vec3::Zero());
  const TruthSamples samples = test::sampled(*truth, lossy, scene, 100 * 9.8 * 1.37);
  const Measurement m = *test::measured("energy_drift", {scene, lossy, &samples, 0}).measurement;
  BOOST_TEST(m.value == 1, boost::test_tools::tolerance(1e-12));  // all of m g h
}

BOOST_AUTO_TEST_CASE(a_free_fall_by_semi_implicit_euler_loses_nothing_once_synchronised) {
  Scene scene = test::thrown_cube();
  const double dt = 1.0 / 30;
  const Trajectory trajectory = run_of(scene, "semi-implicit-euler", dt, 10);
  const JudgedRun run{scene, trajectory, nullptr, 0.5};
  // Rounding of 100 kg falling 490 m, of which all is in play.
  BOOST_TEST(test::measured("energy_drift_synchronised", run).measurement->value < 1e-11);
  // Raw: E - E0 = m g dt (v(t) - v(0)) / 2, up to the step's own energy of g²dt²/8 per kilogram.
  const double raw = 0.5 * 100 * 9.8 * dt * 9.8 * 10;
  const Measurement as_read = *test::measured("energy_drift", run).measurement;
  BOOST_TEST(as_read.value * energy_in_play(scene, 10) == raw, boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(synchronising_takes_most_of_the_sampling_out_of_a_springs_energy) {
  const Scene scene = test::fixed_spring();
  const auto truth = make_truth("reference", scene, 5);
  const Trajectory trajectory = run_of(scene, "semi-implicit-euler", 1.0 / 240, 5);
  const TruthSamples samples = test::sampled(*truth, trajectory, scene, energy_extremes(scene, truth.get(), 5).kinetic);
  const JudgedRun run{scene, trajectory, &samples, 0.5};
  const double raw = test::measured("energy_drift", run).measurement->value;
  const double synchronised = test::measured("energy_drift_synchronised", run).measurement->value;
  // First order against second: with w dt about 0.1, a factor of that size lies between them.
  BOOST_TEST(synchronised < 0.1 * raw);
}

// A tumbling cube that falls for 10 s has 490 kJ of its fall in play, and 50 J of its spin. A spin that loses 1 % of
// its speed loses 2 % of these, and 2e-6 of the fall's.
BOOST_AUTO_TEST_CASE(a_loss_in_the_tumbling_is_not_measured_by_the_fall) {
  const Scene scene = test::thrown_cube();
  Trajectory run = run_of(scene, "velocity-verlet", 1.0 / 30, 10);
  for (std::size_t n = run.samples.size() / 2; n < run.samples.size(); ++n) {
    const MutableBodyColumns bodies = run.samples[n].bodies.columns();
    bodies.set_angular_velocity(0, 0.99 * bodies.angular_velocity(0));
  }
  const JudgedRun judged{scene, run, nullptr, 0};
  BOOST_TEST(test::measured("energy_drift", judged).measurement->value < 1e-5);
  BOOST_TEST(test::measured("internal_energy_drift", judged).measurement->value == 1 - 0.99 * 0.99,
             boost::test_tools::tolerance(1e-6));
  const Stability verdict = verdict_on(judged);
  BOOST_TEST(word_of(verdict.verdict) == "drifting");
  BOOST_TEST(verdict.why.find("the energy about the centre of mass moved by -1.99 % of the 50 J") != std::string::npos,
             verdict.why);
}

BOOST_AUTO_TEST_CASE(an_internal_energy_is_left_to_the_total_where_it_says_no_more) {
  const auto why = [](const Scene& scene) {
    const Trajectory run = run_of(scene, "velocity-verlet", 0.1, 1);
    return test::measured("internal_energy_drift", {scene, run, nullptr, 0}).not_applicable;
  };
  BOOST_TEST(why(test::fixed_spring()).find("spring holds") != std::string::npos);
  Scene cube = test::thrown_cube();
  cube.gravity.setZero(), cube.bodies[0].velocity.setZero();
  BOOST_TEST(why(cube) == "the centre of mass rests: energy_drift says the same");
  cube = test::thrown_cube();
  cube.bodies[0].angular_velocity.setZero();
  BOOST_TEST(why(cube) == "nothing moves about the centre of mass, and no spring is tense");
  cube.forces.push_back({.body = 0, .torque = {1, 0, 0}});
  BOOST_TEST(why(cube) == "contact, dampers, limits, forces or motors may change it");
}

BOOST_AUTO_TEST_CASE(what_a_damper_takes_is_known_from_the_truth) {
  const Scene scene = test::coupled_bodies(3);
  const auto truth = make_truth("reference", scene, 3);
  Trajectory run = test::played(*truth, scene, 0.1, 30);
  const TruthSamples samples = test::sampled(*truth, run, scene, 10);
  run.samples[20].bodies.columns().set_velocity(1, run.samples[20].bodies.columns().velocity(1) * 2);
  const double more = 1.5 * 1 * samples.bodies[20].columns().velocity(1).squaredNorm();  // 3/2 m v², m = 1
  const Measurement m = *test::measured("energy_drift", {scene, run, &samples, 0}).measurement;
  BOOST_TEST(m.value == more / 10, boost::test_tools::tolerance(1e-9));
  // Driven by a force, and without a truth, nothing can be expected.
  BOOST_TEST(test::measured("energy_drift", {scene, run, nullptr, 0}).not_applicable.find("forces") == 0);
}

BOOST_AUTO_TEST_CASE(a_start_at_rest_is_scaled_by_the_fall_of_its_potential) {
  Scene scene;
  scene.gravity = {0, -10, 0};
  scene.bodies = {test::body("a", 1, {1, 1, 1})};
  Trajectory trajectory{1, {}};
  for (const auto& [height, speed] : {std::pair{0.0, 0.0}, {-5.0, 10.0}, {-20.0, 22.0}}) {
    BodyTable bodies(1);
    bodies.columns().set_body(0, {{0, height, 0}, Quat::Identity(), {0, -speed, 0}, Vec3::Zero()});
    trajectory.samples.push_back({static_cast<double>(trajectory.samples.size()), bodies});
  }
  // 242 - 200 J over a fall of 200 J.
  BOOST_TEST(test::measured("energy_drift", {scene, trajectory, nullptr, 0}).measurement->value == 0.21,
             boost::test_tools::tolerance(1e-13));
}

// A bead of 2 kg that 2 N push along a rod against a stop at 1 m, which gives back `restitution` of the speed: it
// meets the stop twice within 3.4 s.
Scene bead_at_a_stop(double restitution) {
  Scene scene;
  scene.bodies = {test::body("bead", 2, {1, 1, 1})};
  scene.joints = {{.a = kWorld, .b = 0, .type = SliderJoint{Vec3::UnitX()}, .upper = 1, .restitution = restitution}};
  scene.motors = {{.joint = 0, .effort = 2, .speed = {}}};
  return scene;
}

// A semi-implicit step meets the stop up to half a step late. Half a step of 1 m/s² is 0.75 dt of a speed after the
// bounce, or 2 J · 1.5 dt of energy at most, of the 2 J at the first stop. Before, each step gave 75 %: the loss of a
// bounce that the truth had made and the run had not.
BOOST_AUTO_TEST_CASE(the_drift_through_a_limit_that_takes_energy_falls_with_dt) {
  for (const double dt : {1.0 / 30, 1.0 / 240, 1.0 / 1000}) {
    const Scene scene = bead_at_a_stop(0.5);
    const Trajectory exact = run_of(scene, "dormand-prince", dt, 3.4);
    TruthSamples truth;
    truth.largest_kinetic_energy = 2;
    for (const Sample& sample : exact.samples) truth.bodies.push_back(sample.bodies), truth.error.push_back(0);
    const auto drift = [&](const Trajectory& run) {
      return test::measured("energy_drift", {scene, run, &truth, 0}).measurement->value;
    };
    const double found = drift(run_of(scene, "semi-implicit-euler", dt, 3.4));
    BOOST_TEST(found < 2 * dt, "dt " << dt << ": " << found);
    BOOST_TEST(found > 0.1 * dt, "dt " << dt << ": " << found);
    // What a stop gives back too much is no delay: (0.7² - 0.5²) of the energy at the stop.
    BOOST_TEST(drift(run_of(bead_at_a_stop(0.7), "semi-implicit-euler", dt, 3.4)) > 0.2, "dt " << dt);
  }
}

BOOST_AUTO_TEST_SUITE_END()
