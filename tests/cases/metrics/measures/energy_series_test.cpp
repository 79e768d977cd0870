// What a scene's energy should be: which scenes may lose or gain some, and what is then expected of a run.
#include "cases/metrics/measures/energy_series.h"

#include <boost/test/unit_test.hpp>

#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_measures_energy_series)

namespace {

Scene ball_and_ground(ContactLaw law) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::on_its_own("ball", Sphere{0.5}, 2, {0, 0, 1.5}), test::plane()};
  scene.contact_default = law;
  return scene;
}

Scene bead() {
  Scene scene;
  scene.bodies = {test::body("bead", 2, {1, 1, 1})};
  scene.joints = {{.a = kWorld, .b = 0, .type = SliderJoint{Vec3::UnitX()}}};
  return scene;
}

// The first body at these speeds [m/s], 1 J at 1 m/s, a second apart.
Trajectory at_speeds(const Scene& scene, const std::vector<double>& speeds) {
  Trajectory run{1, {}};
  for (const double speed : speeds) {
    BodyTable table(scene.bodies.size());
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) table.columns().set_orientation(i, Quat::Identity());
    table.columns().set_velocity(0, {speed, 0, 0});
    run.samples.push_back({static_cast<double>(run.samples.size()), table});
  }
  return run;
}

TruthSamples truth_of(const Trajectory& run, std::size_t good) {
  TruthSamples truth;
  truth.largest_kinetic_energy = 8;
  for (std::size_t n = 0; n < run.samples.size(); ++n) {
    truth.bodies.push_back(run.samples[n].bodies), truth.error.push_back(n < good ? 0 : 1);
  }
  return truth;
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_thing_that_may_take_or_give_energy_is_known) {
  struct Row {
    const char* what;
    Scene scene;
    bool may_lose, may_change;
  };
  const auto with = [](Scene scene, const auto& change) {
    change(scene);
    return scene;
  };
  const Scene elastic = ball_and_ground({1, 0});
  for (const Row& row : {
           Row{"elastic", elastic, false, false},
           {"plastic by a tenth", ball_and_ground({0.9, 0}), true, true},
           {"rubbing", ball_and_ground({1, 0.1}), true, true},
           {"a pair that is plastic",
            with(elastic,
                 [](Scene& s) {
                   s.contact_pairs = {{0, 1, {0.5, 0}}};
                 }),
            true, true},
           {"a pair that rubs",
            with(elastic,
                 [](Scene& s) {
                   s.contact_pairs = {{0, 1, {1, 0.5}}};
                 }),
            true, true},
           {"a ball that touches nothing",
            with(ball_and_ground({0, 1}), [](Scene& s) { s.bodies[0].collides = false; }), false, false},
           {"a spring",
            with(elastic, [](Scene& s) { s.springs = {test::spring(kWorld, Vec3::Zero(), 0, Vec3::Zero(), 10, 1)}; }),
            false, false},
           {"a damper",
            with(elastic,
                 [](Scene& s) { s.springs = {test::spring(kWorld, Vec3::Zero(), 0, Vec3::Zero(), 10, 1, 0.1)}; }),
            false, true},
           {"a force", with(elastic, [](Scene& s) { s.forces = {{.body = 0}}; }), false, true},
           {"a joint", bead(), false, false},
           {"a joint that rubs", with(bead(), [](Scene& s) { s.joints[0].damping = 0.1; }), false, true},
           {"a soft limit", with(bead(), [](Scene& s) { s.joints[0].upper = 1, s.joints[0].restitution = 0.9; }), false,
            true},
           {"a hard limit", with(bead(), [](Scene& s) { s.joints[0].upper = 1, s.joints[0].restitution = 1; }), false,
            false},
           {"a motor", with(bead(), [](Scene& s) { s.motors = {{.joint = 0, .effort = 1, .speed = {}}}; }), false,
            true},
       }) {
    BOOST_TEST_CONTEXT(row.what) {
      BOOST_TEST(contact_may_lose(row.scene) == row.may_lose);
      BOOST_TEST(may_change_energy(row.scene) == row.may_change);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_rise_is_above_the_lowest_before_in_both_readings) {
  BOOST_TEST((lowest_so_far({5, 3, 4, 2, 6}) == std::vector<double>{5, 3, 3, 2, 2}));
  BOOST_TEST(lowest_so_far({}).empty());
  const std::vector<double> one = {5, 3, 4, 2, 6}, other = {5, 4, 6, 6, 6};
  BOOST_TEST((rises_of({{one, one}, {other, other}}) == std::vector<double>{0, 0, 1, 0, 2}));
  // Bounds: only what lies above each value that the bounds before admit is a rise.
  BOOST_TEST((rises_of({{{5, 1, 4, 6}, {5, 3, 4, 7}}}) == std::vector<double>{0, 0, 1, 3}));
}

// A ball by semi-implicit steps between two grounds: v_n = v_(n-1) - g h and x_n = x_(n-1) + h v_n, and at each third
// step an elastic impact instead of gravity. The energy, as read, changes by m v g h / 2. At step 6 the impact changes
// the velocity by 1.24 g h, so its size does not tell it from gravity. The flight on either side determines each
// velocity.
BOOST_AUTO_TEST_CASE(between_impacts_the_energy_of_a_semi_implicit_step_stays) {
  const Scene scene = ball_and_ground({1, 0});
  const double h = 0.1, g = scene.gravity.norm();
  Trajectory run{.dt = h, .samples = {}};
  double z = 5, v = -0.62 * g * h;
  std::vector<double> flown;  // J, of the flight that each step belongs to
  for (int n = 0; n <= 12; ++n) {
    if (n > 0) v = n % 3 == 0 ? -v : v - g * h, z += h * v;
    BodyTable bodies(2);
    for (std::size_t i = 0; i < 2; ++i)
      bodies.columns().set_body(i, {Vec3::Zero(), Quat::Identity(), Vec3::Zero(), Vec3::Zero()});
    bodies.columns().set_position(0, -z * scene.gravity / g), bodies.columns().set_velocity(0, -v * scene.gravity / g);
    run.samples.push_back({n * h, KeptBodies(std::as_const(bodies).columns())});
    const double at_position = v - 0.5 * g * h;
    flown.push_back(scene.bodies[0].mass * (0.5 * at_position * at_position + g * z));
  }
  const JudgedRun judged{scene, run, nullptr, 0.5};
  const EnergyBounds& found = energies_of(judged, 0.5);
  for (std::size_t n = 0; n < flown.size(); ++n) {
    BOOST_TEST(found.least[n] == flown[n], boost::test_tools::tolerance(1e-12));
    BOOST_TEST(found.most[n] == flown[n], boost::test_tools::tolerance(1e-12));
  }
}

// Relative to the truth's largest kinetic energy, 8 J: 1e-9 of it is rounding.
BOOST_AUTO_TEST_CASE(contact_of_which_the_truth_keeps_its_energy_is_held_to_it) {
  const Scene scene = ball_and_ground({0.5, 0});
  const Trajectory run = at_speeds(scene, {2, 1, 1.5, 2});
  for (const auto& [share, is_kept] : {std::pair{0.9, true}, {1.2, false}, {-0.9, true}, {-1.2, false}}) {
    TruthSamples truth = truth_of(at_speeds(scene, {2, 2, 2, 2}), 4);
    truth.bodies[2].columns().set_velocity(0, {std::sqrt(4 + share * 8e-9), 0, 0});
    const EnergySeries series = energy_series({scene, run, &truth, 0}, 0);
    BOOST_TEST(series.only_gains_count != is_kept, share);
    BOOST_TEST((series.expected == (is_kept ? std::vector<double>{4, 4, 4, 4} : std::vector<double>{4, 1, 1, 1})));
    BOOST_TEST(series.scale == 8);
    BOOST_TEST(series.not_applicable == "");
  }
  const TruthSamples unknown = truth_of(run, 1);  // good at the start alone
  BOOST_TEST(energy_series({scene, run, &unknown, 0}, 0).only_gains_count);
}

// A truth that ends before the first impact keeps its energy, and an impact may take some after that.
BOOST_AUTO_TEST_CASE(a_truth_of_a_part_of_the_run_does_not_say_that_impacts_keep_the_energy) {
  const Scene scene = ball_and_ground({0.5, 0});
  const Trajectory run = at_speeds(scene, {2, 2, 1, 1});
  const TruthSamples truth = truth_of(at_speeds(scene, {2, 2, 2, 2}), 3);
  const EnergySeries series = energy_series({scene, run, &truth, 0}, 0);
  BOOST_TEST(series.only_gains_count);
  BOOST_TEST((series.found == std::vector<double>{4, 4, 1, 1}));
  BOOST_TEST((series.expected == std::vector<double>{4, 4, 1, 1}));
}

BOOST_AUTO_TEST_CASE(what_is_driven_or_damped_is_held_to_the_truths_change_up_to_its_horizon) {
  Scene damped = bead();
  damped.joints[0].damping = 1;
  Scene driven = bead();
  driven.forces = {{.body = 0, .force = {1, 0, 0}}};
  for (const Scene& scene : {damped, driven}) {
    const Trajectory run = at_speeds(scene, {2, 1, 1.5, 2});
    const TruthSamples truth = truth_of(at_speeds(scene, {3, 2, 1, 0}), 3);
    const EnergySeries series = energy_series({scene, run, &truth, 0}, 0);
    BOOST_TEST((series.found == std::vector<double>{4, 1, 2.25}));
    BOOST_TEST((series.expected == std::vector<double>{4, -1, -4}));
    BOOST_TEST(!series.only_gains_count);
    const EnergySeries alone = energy_series({scene, run, nullptr, 0}, 0);
    BOOST_TEST(alone.only_gains_count == scene.forces.empty());
    BOOST_TEST(alone.not_applicable.empty() == scene.forces.empty());
  }
}

// Without a truth, or with a truth at rest, the scale is the scene's energy in play over the run or the case, whichever
// is longer. For a free fall of 2 kg at 10 m/s² it is 100 t² J.
BOOST_AUTO_TEST_CASE(the_scale_is_the_truths_or_what_is_in_play_over_the_longer_of_run_and_case) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::body("ball", 2, {1, 1, 1})};
  const Trajectory run = at_speeds(scene, {0, 0, 0});
  JudgedRun judged{scene, run, nullptr, 0};
  BOOST_TEST(energy_scale(judged) == 400, boost::test_tools::tolerance(1e-12));
  judged.duration = 3;
  BOOST_TEST(energy_scale(judged) == 900, boost::test_tools::tolerance(1e-12));
  TruthSamples truth = truth_of(run, 3);
  judged.truth = &truth;
  BOOST_TEST(energy_scale(judged) == 8);
  truth.largest_kinetic_energy = 0;
  BOOST_TEST(energy_scale(judged) == 900, boost::test_tools::tolerance(1e-12));
  truth.largest_kinetic_energy = 0.5;
  BOOST_TEST(energy_scale(judged) == 0.5);
  const Trajectory none{1, {}};
  JudgedRun unborn{scene, none, nullptr, 0};
  unborn.duration = 0.5;
  BOOST_TEST(energy_scale(unborn) == 25, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_SUITE_END()
