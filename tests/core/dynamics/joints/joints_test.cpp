#include "core/dynamics/joints/joints.h"

#include <boost/test/unit_test.hpp>
#include <ctime>

#include "core/dynamics/model/energy.h"

#include "tests/core/dynamics/joints/jointed_run.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_joints_joints)

namespace {

// A chain of rods along x on hinges about z, from the world, let go.
Scene chain(int links) {
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  for (int i = 0; i < links; ++i) {
    scene.bodies.push_back(test::body("link", 0.1, {1e-5, 1e-4, 1e-4}, {0.1 * i + 0.05, 0, 0}));
    scene.joints.push_back({i - 1, i, HingeJoint{{0.1 * i, 0, 0}, Vec3::UnitZ()}});
  }
  return scene;
}

double seconds_for(int links, int steps) {
  const auto world = CoreEngine().load(chain(links), {.method = "semi-implicit-euler", .options = {}});
  double best = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 5; ++round) {
    const auto start = std::clock();
    for (int n = 0; n < steps; ++n) world->step(1e-3);
    best = std::min(best, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return best / links / steps;
}

}  // namespace

// Rows and ranks as counted by hand and by singular values.
BOOST_AUTO_TEST_CASE(redundant_rows_are_counted_at_the_start) {
  const std::vector<std::tuple<std::string, int, int>> expected = {
      {"joints/pendulum-90", 5, 5},        {"mechanisms/slider-crank", 20, 17}, {"mechanisms/four-bar", 20, 17},
      {"mechanisms/iftomm-a02-2", 35, 29}, {"mechanisms/iftomm-a04", 30, 29},   {"mechanisms/iftomm-a02-40", 605, 485},
      {"mechanisms/cardan-shaft", 20, 17}, {"mechanisms/trammel", 20, 17},      {"mechanisms/iftomm-a03", 50, 41}};
  for (const auto& [id, rows, rank] : expected) {
    const Scene scene = test::suite_scene(id);
    const System system(scene);
    const Joints joints(scene, system);
    BOOST_TEST_CONTEXT(id) {
      BOOST_TEST(joints.rows() == rows);
      BOOST_TEST(joints.rank() == rank);
      BOOST_TEST(joints.warning() == "");
    }
  }
}

// Two sliders at an angle hold a body; one that turns with a speed cannot be held by a third hinge off its axis.
BOOST_AUTO_TEST_CASE(joints_that_contradict_each_other_are_named) {
  Scene scene;
  scene.bodies = {test::body("bar", 1, {1, 1, 1})};
  scene.bodies[0].velocity = {1, 0, 0};
  // Both distances turn about their own pivots, on one line: the centre may start across it, and cannot go on.
  scene.joints = {{kWorld, 0, DistanceJoint{{0, 1, 0}, {0, 0, 0}}}, {kWorld, 0, DistanceJoint{{0, -1, 0}, {0, 0, 0}}}};
  const System system(scene);
  const Joints joints(scene, system);
  BOOST_TEST(joints.rank() == 1);
  BOOST_TEST((joints.warning().find("contradict") != std::string::npos));

  const auto world = CoreEngine().load(scene, {.method = "rk4", .options = {}});
  world->step(1e-3);
  BOOST_TEST((world->solver_warning().find("the distance of 'world' and 'bar'") != std::string::npos));
}

// A crank and a rod of one length, the crank upright: the slider is above the crank's hinge and can go either way. A
// degree beside it, and where rows repeat others for good, nothing is said.
BOOST_AUTO_TEST_CASE(a_singular_position_at_the_start_is_named_at_once) {
  const auto crank_at = [](double angle) {
    const Vec3 arm(std::cos(angle), std::sin(angle), 0), foot(2 * arm.x(), 0, 0);
    Scene scene;
    scene.bodies = {test::body("crank", 1, {0.01, 0.1, 0.1}, 0.5 * arm),
                    test::body("rod", 1, {0.01, 0.1, 0.1}, 0.5 * (arm + foot)),
                    test::body("slider", 1, {1, 1, 1}, foot)};
    scene.joints = {{kWorld, 0, HingeJoint{{0, 0, 0}, Vec3::UnitZ()}},
                    {0, 1, HingeJoint{arm, Vec3::UnitZ()}},
                    {1, 2, HingeJoint{foot, Vec3::UnitZ()}},
                    {kWorld, 2, SliderJoint{Vec3::UnitX()}}};
    return scene;
  };
  const auto warning_at = [&](double angle) {
    const Scene scene = crank_at(angle);
    const System system(scene);
    return Joints(scene, system).warning();
  };
  const double right_angle = std::acos(0.0);
  BOOST_TEST((warning_at(right_angle).find("singular position at t = 0") != std::string::npos));
  BOOST_TEST(warning_at(right_angle - 0.02) == "");
  BOOST_TEST(warning_at(0.8) == "");
}

// A crank, a rod and a slider, in units in which all lengths are `scale` times as large, and moved out of place.
struct MovedCrank {
  explicit MovedCrank(double scale) {
    const double inertia = scale * scale;
    const Vec3 arm = scale * Vec3(0.6, 0.8, 0), foot = scale * Vec3(1.2, 0, 0);
    scene.bodies = {test::body("crank", 1, inertia * Vec3(0.125, 0.25, 0.25), 0.5 * arm),
                    test::body("rod", 2, inertia * Vec3(0.125, 0.5, 0.5), 0.5 * (arm + foot)),
                    test::body("slider", 1, inertia * Vec3(1, 1, 1), foot)};
    scene.joints = {{kWorld, 0, HingeJoint{{0, 0, 0}, Vec3::UnitZ()}},
                    {0, 1, HingeJoint{arm, Vec3::UnitZ()}},
                    {1, 2, HingeJoint{foot, Vec3::UnitZ()}},
                    {kWorld, 2, SliderJoint{Vec3::UnitX()}}};
    const System system(scene);
    Joints joints(scene, system);
    set_initial_state(scene, closed.columns());
    for (int i = 0; i < 3; ++i) {
      const MutableBodyColumns state = closed.columns();
      state.set_position(i, state.position(i) + scale * 0x1p-6 * Vec3(i - 1, 0.5 * i, 0.25));
      const Quat turn = rotation_by(0x1p-5 * Vec3(0.5, i - 1, 1));
      state.set_orientation(i, (turn * state.orientation(i)).normalized());
      if (state.has_rotation()) state.set_rotation(i, matrix_of(state.orientation(i)));
    }
    joints.project(closed.columns());
    gap = joints.gap(closed.columns());
    warning = joints.warning();
  }

  Scene scene;
  BodyTable closed{3};
  double gap = 0;  // m
  std::string warning;
};

// Powers of two scale each number exactly, so that the same bits must come out. Other units leave roundings. Rows that
// keep an angle have gaps without a unit, which no tolerance in metres may judge.
BOOST_AUTO_TEST_CASE(closing_the_joints_does_not_depend_on_the_unit_of_length) {
  const MovedCrank own(1);
  BOOST_TEST(own.gap < 1e-15);
  for (const double scale : {0x1p-30, 0x1p-10, 0x1p-3, 0x1p4, 0x1p10, 0x1p30, 0.1, 10.0, 1e6}) {
    const MovedCrank other(scale);
    int exponent = 0;
    const double most = std::frexp(scale, &exponent) == 0.5 ? 0 : 4e-15;
    BOOST_TEST(other.warning == "", scale);
    BOOST_TEST(other.gap / scale < 2e-15, scale);
    for (int i = 0; i < 3; ++i) {
      const BodyColumns here = std::as_const(other.closed).columns(), there = std::as_const(own.closed).columns();
      BOOST_TEST((here.position(i) / scale - there.position(i)).norm() <= most, scale << ", body " << i);
      BOOST_TEST((here.orientation(i).coeffs() - there.orientation(i).coeffs()).norm() <= most,
                 scale << ", body " << i);
    }
  }
}

// A wheel on an arm, tilted out of its axle about its own centre: all gaps are sines.
BOOST_AUTO_TEST_CASE(a_tilt_is_closed_in_any_unit_of_length) {
  for (const double scale : {1e-9, 1e-3, 1.0, 1e3, 1e9}) {
    Scene scene;
    scene.bodies = {test::body("arm", 1, scale * scale * Vec3(0.1, 0.1, 0.1), {0.5 * scale, 0, 0}),
                    test::body("wheel", 1, scale * scale * Vec3(0.1, 0.1, 0.1), {scale, 0, 0})};
    scene.joints = {{kWorld, 0, HingeJoint{{0, 0, 0}, Vec3::UnitZ()}},
                    {0, 1, HingeJoint{{scale, 0, 0}, Vec3::UnitZ()}}};
    const System system(scene);
    Joints joints(scene, system);
    BodyTable state(2);
    set_initial_state(scene, state.columns());
    state.columns().set_orientation(1, rotation_by({1e-7, 0, 0}));
    if (state.columns().has_rotation()) state.columns().set_rotation(1, matrix_of(rotation_by({1e-7, 0, 0})));
    joints.project(state.columns());
    const Vec3 axle = state.columns().orientation(1) * Vec3::UnitZ();
    const Vec3 of_arm = state.columns().orientation(0) * Vec3::UnitZ();
    BOOST_TEST(axle.cross(of_arm).norm() < 1e-15, scale << ": " << axle.cross(of_arm).norm());
    BOOST_TEST(joints.gap(state.columns()) / scale < 1e-15);
    BOOST_TEST(joints.warning() == "", scale);
  }
}

// Two particles on a rod without mass have no arms: the rod's own length is the scale.
BOOST_AUTO_TEST_CASE(a_distance_between_particles_is_closed_in_any_unit_of_length) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    Scene scene;
    scene.bodies = {test::body("one", 1, {1, 1, 1}), test::body("other", 1, {1, 1, 1}, {0, 3 * scale, 0})};
    scene.joints = {{0, 1, DistanceJoint{{0, 0, 0}, {0, 0, 0}}}};
    const System system(scene);
    Joints joints(scene, system);
    BodyTable state(2);
    set_initial_state(scene, state.columns());
    state.columns().set_position(0, {0.2 * scale, -0.1 * scale, 0});
    joints.project(state.columns());
    const double length = (state.columns().position(1) - state.columns().position(0)).norm();
    BOOST_TEST(std::abs(length / scale - 3) < 2e-15, scale << ": " << length / scale - 3);
    BOOST_TEST(joints.warning() == "");
  }
}

// At these steps a body turns so far that the iteration for the joints' impulse comes to another solution, or to none,
// unless it is given up when the gap grows. The energy then grew by half, or without bounds.
BOOST_AUTO_TEST_CASE(joints_close_at_the_nearest_pose_or_are_projected) {
  const Scene scene = test::suite_scene("mechanisms/mujoco-pendulum");
  constexpr double kInPlay = 296;  // J, as the verdict has it
  for (const double dt : {1.0 / 30, 1.0 / 60}) {
    const auto world = CoreEngine().load(scene, {.method = "semi-implicit-euler", .options = {}});
    Snapshot snapshot;
    world->read(snapshot);
    const double start = energy(scene, snapshot.bodies());
    double most = 0;
    for (int n = 0; n < 3 / dt; ++n) {
      test::step_until(*world, dt, dt);
      world->read(snapshot);
      most = std::max(most, std::abs(energy(scene, snapshot.bodies()) - start));
    }
    // The half step between velocities and poses alone is worth 3.5 % here.
    BOOST_TEST(most < 0.1 * kInPlay, most << " J at " << dt << " s");
  }
}

// The mass-weighted least-norm projection: two bodies on one ball joint, separated by a gap, each move by their share
// of the inverse masses, because the anchor is at both centres.
BOOST_AUTO_TEST_CASE(projection_moves_each_body_by_its_inverse_mass) {
  Scene scene;
  scene.bodies = {test::body("light", 1, {1, 1, 1}), test::body("heavy", 3, {1, 1, 1})};
  scene.joints = {{0, 1, BallJoint{{0, 0, 0}}}};
  const System system(scene);
  Joints joints(scene, system);
  BodyTable state(2);
  set_initial_state(scene, state.columns());
  state.columns().set_position(0, {0.4, 0, 0});
  state.columns().set_velocity(1, {0, 0, 4});
  joints.project(state.columns());
  BOOST_TEST((state.columns().position(0) - Vec3(0.1, 0, 0)).norm() < 1e-15);
  BOOST_TEST((state.columns().position(1) - Vec3(0.1, 0, 0)).norm() < 1e-15);
  BOOST_TEST((state.columns().velocity(0) - Vec3(0, 0, 3)).norm() < 1e-15);
  BOOST_TEST((state.columns().velocity(1) - Vec3(0, 0, 3)).norm() < 1e-15);
  BOOST_TEST(joints.warning() == "");
}

// A free mechanism keeps its momenta: the joints' forces are pairs. Springs and dampers take energy from it, not these.
BOOST_AUTO_TEST_CASE(a_free_mechanism_keeps_its_momenta) {
  const Scene scene = test::suite_scene("mechanisms/satellite");
  BodyTable start(scene.bodies.size());
  set_initial_state(scene, start.columns());
  const auto momenta = [&](const BodyTable& state) {
    Vec6 both;
    both << linear_momentum(scene, state.columns()), angular_momentum(scene, state.columns(), Vec3::Zero());
    return both;
  };
  const Vec6 before = momenta(start);
  for (const char* method : {"semi-implicit-euler", "velocity-verlet", "rk4", "dormand-prince"}) {
    const Vec6 after = momenta(test::state_after(scene, method, 0.01, 2));
    // The linear momentum to rounding; the angular to the method's error of L, 1e-2 at first order.
    BOOST_TEST_CONTEXT(method) { BOOST_TEST((after - before).head<3>().norm() < 1e-11 * before.norm()); }
  }
  const Vec6 after = momenta(test::state_after(scene, "dormand-prince", 0.01, 2));
  BOOST_TEST((after - before).norm() < 1e-11 * before.norm());
}

BOOST_AUTO_TEST_CASE(no_row_of_a_long_chain_passes_for_a_repeated_one) {
  const Scene scene = chain(1000);
  const System system(scene);
  const Joints joints(scene, system);
  BOOST_TEST(joints.rank() == 5000);
  BOOST_TEST(joints.warning() == "");
}

// Elimination along a chain takes a time in proportion to it. A dense factor of 1000 links would take ten thousand
// times that of 10 for each link; caches and a busy machine less than 4.
BOOST_AUTO_TEST_CASE(a_link_of_a_thousand_costs_as_much_as_one_of_ten) {
  BOOST_TEST(seconds_for(1000, 2) < 4 * seconds_for(10, 200));
}

BOOST_AUTO_TEST_SUITE_END()
