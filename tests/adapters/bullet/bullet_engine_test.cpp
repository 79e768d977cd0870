// Bullet's traps, each found again, so that a new Bullet that mends or moves one is noticed.
#include "adapters/bullet/bullet_engine.h"

#include <btBulletDynamicsCommon.h>

#include <boost/test/unit_test.hpp>
#include <functional>
#include <numbers>

#include "core/base/error.h"
#include "tests/adapters/free_body_measures.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_bullet_bullet_engine)

namespace {

constexpr double kHalfTurn = std::numbers::pi;

// Bullet itself, without the adapter: one ball of 1 kg in empty space.
struct RawBall {
  btSphereShape shape{0.1};
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btRigidBody body{btRigidBody::btRigidBodyConstructionInfo(1, nullptr, &shape, btVector3(1, 1, 1))};
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};

  RawBall() {
    world.setGravity(btVector3(0, 0, 0));
    world.addRigidBody(&body);
  }
};

void push_before_each_step(btDynamicsWorld* world, btScalar) {
  static_cast<RawBall*>(world->getWorldUserInfo())->body.applyCentralForce(btVector3(1, 0, 0));
}

struct Push : btActionInterface {
  btRigidBody* body;
  explicit Push(btRigidBody* pushed) : body(pushed) {}
  void updateAction(btCollisionWorld*, btScalar) override { body->applyCentralForce(btVector3(1, 0, 0)); }
  void debugDraw(btIDebugDraw*) override {}
};

double yaw_of(const Quat& q) {
  const Vec3 x = q * Vec3::UnitX();
  return std::atan2(x.y(), x.x());
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_lone_thirtieth_of_a_second_advances_by_a_sixtieth) {
  RawBall ball;
  ball.body.setLinearVelocity(btVector3(1, 0, 0));
  ball.world.stepSimulation(1.0 / 30);
  // Bullet's 1/60 is a single-precision number.
  BOOST_TEST(std::abs(ball.body.getWorldTransform().getOrigin().x() - 1.0 / 60) < 1e-8);
  ball.world.stepSimulation(1.0 / 30, 0);
  BOOST_TEST(std::abs(ball.body.getWorldTransform().getOrigin().x() - 1.0 / 60 - 1.0 / 30) < 1e-8);
}

BOOST_AUTO_TEST_CASE(forces_of_a_sub_step_pile_up_or_are_dropped) {
  const double h = 1.0 / 256;  // eight sub-steps, exactly
  RawBall pushed;
  pushed.world.setInternalTickCallback(push_before_each_step, &pushed, true);
  pushed.world.stepSimulation(8 * h, 8, h);
  BOOST_TEST(std::abs(pushed.body.getLinearVelocity().x() - (1 + 2 + 3 + 4 + 5 + 6 + 7 + 8) * h) < 1e-15);

  RawBall acted;
  Push push(&acted.body);
  acted.world.addAction(&push);
  acted.world.stepSimulation(h, 0);
  BOOST_TEST(acted.body.getLinearVelocity().x() == 0);
}

BOOST_AUTO_TEST_CASE(the_gyroscopic_term_damps_a_free_top_or_blows_it_up) {
  // Measured with Bullet 3.24; one more digit than the number is the margin.
  BOOST_TEST(std::abs(energy_gained_by_top("bullet") + 0.7638) < 1e-3);
  BOOST_TEST(std::abs(energy_gained_by_top("bullet@stock") + 0.7638) < 1e-3);
  BOOST_TEST(std::abs(energy_gained_by_top("bullet,gyroscopic=implicit-world") + 0.7638) < 1e-3);
  BOOST_TEST(std::abs(energy_gained_by_top("bullet,gyroscopic=off")) < 1e-3);
  // Explicit gains 2160 % only because Bullet as shipped cuts the torque off at 100 N m; without that it has no end.
  BOOST_TEST(std::abs(energy_gained_by_top("bullet,gyroscopic=explicit@stock") - 21.59) < 0.1);
  BOOST_TEST(!(energy_gained_by_top("bullet,gyroscopic=explicit") < 1e6));
}

BOOST_AUTO_TEST_CASE(stock_bodies_fall_asleep_after_two_seconds_and_matched_ones_do_not) {
  Scene scene;
  scene.bodies.resize(1);
  scene.bodies[0].velocity = {0.5, 0, 0};
  scene.bodies[0].angular_velocity = {0, 0.5, 0};
  const double dt = 1.0 / 60;
  const BodyState stock = body_after(*load_run("bullet@stock", scene), dt, 600);
  BOOST_TEST(stock.velocity.norm() == 0);
  BOOST_TEST(std::abs(stock.position.x() - 0.5 * 2) < 3 * 0.5 * dt);  // it stops within three steps of two seconds
  BOOST_TEST(std::abs(body_after(*load_run("bullet", scene), dt, 600).position.x() - 5) < 1e-12);
}

BOOST_AUTO_TEST_CASE(a_turn_beyond_a_quarter_of_pi_in_one_step_falls_short) {
  const double dt = 1.0 / 30, limit = BulletEngine().info().max_rotation_per_step;
  Scene scene;
  scene.bodies.resize(1);
  const auto turned_by = [&](double angle) {
    scene.bodies[0].angular_velocity = {0, 0, angle / dt};
    const BodyState after = body_after(*load_run("bullet", scene), dt, 1);
    BOOST_TEST(after.angular_velocity.z() == angle / dt);  // the velocity is not clamped
    return angle_between(after.orientation, Quat::Identity());
  };
  BOOST_TEST(limit == kHalfTurn / 4);
  for (const double angle : {0.1, 0.5, 0.999 * limit}) BOOST_TEST(std::abs(turned_by(angle) - angle) < 1e-12);
  // The half-angle's cosine is clamped at pi/8, but its sine grows with w. The result is their arc tangent, which may
  // exceed pi/4 and even pi/2 but never reaches pi.
  for (const double angle : {0.8, 1.0, 1.6, 2.0, 3.0}) {
    const double law = 2 * std::atan(angle / limit * std::tan(kHalfTurn / 8));
    BOOST_TEST(std::abs(turned_by(angle) - law) < 1e-12);
    BOOST_TEST(law < angle);
    BOOST_TEST(why_unsupported(BulletEngine().info(), scene, dt) != "");
  }
}

BOOST_AUTO_TEST_CASE(the_quaternion_flips_its_sign_and_the_matrix_does_not) {
  Scene scene;
  scene.bodies.resize(1);
  scene.bodies[0].angular_velocity = {1, 2, 3};
  const auto world = load_run("bullet", scene);
  int flips = 0;
  BodyState last = body_after(*world, 0.01, 1);
  for (int i = 0; i < 1000; ++i) {
    const BodyState now = body_after(*world, 0.01, 1);
    if (now.orientation.dot(last.orientation) < 0) ++flips;
    BOOST_TEST(angle_between(now.orientation, last.orientation) < 0.04);  // a step turns by 0.0374 rad
    last = now;
  }
  BOOST_TEST(flips > 0);
  Snapshot snapshot;
  world->read(snapshot);
  BOOST_REQUIRE(snapshot.bodies().has_rotation());
  const Mat3 R = snapshot.bodies().rotation(0);
  BOOST_TEST((R.transpose() * R - Mat3::Identity()).norm() < 1e-14);  // made from a unit quaternion in each step
}

BOOST_AUTO_TEST_CASE(stock_restitution_does_not_converge_and_matched_does) {
  // A contact point is made before the touch and takes away the speed that closes the gap; measured with Bullet 3.24.
  BOOST_TEST(std::abs(first_apex("bullet@stock", 1, 1.0 / 240) - 1.254) < 1e-3);
  BOOST_TEST(std::abs(first_apex("bullet@stock", 1, 1e-3) - 0.541) < 1e-3);
  for (const double dt : {1e-3, 1.0 / 240, 1.0 / 30}) {
    // The impact falls somewhere inside a step and is worth half a step's fall: g dt / 2 of 5.18 m/s, twice in energy.
    BOOST_TEST(std::abs(first_apex("bullet", 1, dt) - 1) < 9.8 * dt / 5.18);
  }
}

BOOST_AUTO_TEST_CASE(slow_impacts_bounce_only_in_matched) {
  Scene scene = sliding_box(0, 0, 0);
  scene.bodies[0].shape = Sphere{0.1};
  scene.bodies[0].position = {0, 0, 0.1005};
  scene.bodies[0].velocity = {0, 0, -0.15};  // m/s, below Bullet's threshold of 0.2
  scene.gravity = Vec3::Zero();
  scene.contact_default = {1, 0};
  BOOST_TEST(std::abs(body_after(*load_run("bullet", scene), 1e-3, 20).velocity.z() - 0.15) < 1e-6);
  BOOST_TEST(body_after(*load_run("bullet@stock", scene), 1e-3, 20).velocity.z() < 0.05);
}

// A plate that flies flat passes, in a step, many times its own thickness, but not its width. The ball inside it
// counts.
BOOST_AUTO_TEST_CASE(a_thin_plate_does_not_fly_through_a_thin_wall_in_matched) {
  Scene scene = sliding_box(0, 0, 0);
  scene.gravity = Vec3::Zero();
  scene.bodies[0].shape = Box{{0.02, 1, 1}};
  scene.bodies[0].position = {-1, 0, 0}, scene.bodies[0].velocity = {24, 0, 0};  // 0.4 m a step
  scene.bodies[1] = scene.bodies[0];
  scene.bodies[1].shape = Box{{0.02, 10, 10}};
  scene.bodies[1].position = Vec3::Zero(), scene.bodies[1].velocity = Vec3::Zero();
  scene.bodies[1].fixed = true;
  scene.contact_default = {0, 0};
  BOOST_TEST(body_after(*load_run("bullet", scene), 1.0 / 60, 30).position.x() < 0);
  BOOST_TEST(body_after(*load_run("bullet@stock", scene), 1.0 / 60, 30).position.x() > 0);
}

BOOST_AUTO_TEST_CASE(a_shot_through_a_thin_wall_is_stopped_only_in_matched) {
  Scene scene = sliding_box(0, 0, 0);
  scene.gravity = Vec3::Zero();
  scene.bodies[0].shape = Box{{1, 1, 1}};
  scene.bodies[0].position = {-10, 0, 0}, scene.bodies[0].velocity = {400, 0, 0};
  scene.bodies[1] = scene.bodies[0];
  scene.bodies[1].name = "wall", scene.bodies[1].shape = Box{{0.01, 9, 9}}, scene.bodies[1].fixed = true;
  scene.bodies[1].position = scene.bodies[1].velocity = Vec3::Zero();
  scene.contact_default = {0, 0};
  // The ball inside it, half a metre, is stopped at the wall: it has no more than a rounding to go in.
  BOOST_TEST(body_after(*load_run("bullet", scene), 1.0 / 30, 30).position.x() < -0.5);
  BOOST_TEST(body_after(*load_run("bullet@stock", scene), 1.0 / 30, 30).position.x() > 300);
}

BOOST_AUTO_TEST_CASE(a_sliding_box_keeps_straight_only_with_all_its_corners) {
  for (const double direction : {0.0, kHalfTurn / 8, kHalfTurn / 4, kHalfTurn / 3}) {
    BOOST_TEST_CONTEXT("direction " << direction) {
      // A semi-implicit step brakes one step early: mu g dt / v0 = 3.3 % at 1/30. The solver's ten sweeps leave the
      // rest.
      BOOST_TEST(std::abs(stop_distance_ratio("bullet", direction, 1.0 / 30) - 1) < 0.035);
      BOOST_TEST(std::abs(stop_distance_ratio("bullet", direction, 1.0 / 240) - 1) < 0.005);
      const BodyState matched = body_after(*load_run("bullet", sliding_box(5, direction, 0.5)), 1.0 / 30, 60);
      BOOST_TEST(std::abs(yaw_of(matched.orientation)) < 1e-2);
    }
  }
  // The stock setting finds one corner of the box per step, which tips the box over that corner at coarse steps.
  BOOST_TEST(stop_distance_ratio("bullet@stock", 0, 1.0 / 30) > 1.1);
  BOOST_TEST(std::abs(yaw_of(body_after(*load_run("bullet@stock", sliding_box(5, 0, 0.5)), 1.0 / 30, 60).orientation)) >
             0.2);
}

BOOST_AUTO_TEST_CASE(friction_beyond_ten_is_not_clamped) {
  // Flat, so that it does not tip: its centre lies 5 mm above ground that brakes with 20 times its weight.
  const double ratio = stop_distance_ratio("bullet", 0, 1e-4, 20, 20, {0.4, 0.4, 0.01});
  BOOST_TEST(std::abs(ratio - 1) < 0.01);  // clamped to Bullet's 10 it would be 2
}

BOOST_AUTO_TEST_CASE(bodies_that_are_not_ours_keep_bullets_own_friction) {
  load_run("bullet", asymmetric_top());  // installs the pair laws
  RawBall one, other;
  one.body.setFriction(20), other.body.setFriction(2);
  BOOST_TEST(gCalculateCombinedFrictionCallback(&one.body, &other.body) == 10);
  one.body.setRestitution(0.5), other.body.setRestitution(0.5);
  BOOST_TEST(gCalculateCombinedRestitutionCallback(&one.body, &other.body) == 0.25);
}

BOOST_AUTO_TEST_CASE(options_reach_the_engine_and_are_read_back) {
  const auto in_force = [](const std::string& run) {
    const SettingsInForce settings = load_run(run, asymmetric_top())->settings_in_force();
    return std::map<std::string, std::string>(settings.begin(), settings.end());
  };
  auto found = in_force("bullet,iterations=33,gyroscopic=explicit,split-impulse=off");
  BOOST_TEST(found["iterations"] == "33");
  BOOST_TEST(found["gyroscopic"] == "explicit");
  BOOST_TEST(found["split impulse"] == "off");
  BOOST_TEST(found["sleeping"] == "off");
  found = in_force("bullet@stock");
  BOOST_TEST(found["iterations"] == "10");
  BOOST_TEST(found["gyroscopic"] == "implicit-body");
  BOOST_TEST(found["split impulse"] == "on");
  BOOST_TEST(found["sleeping"] == "on, after 2 s below 0.8 m/s and 1 rad/s");
}

// Four corners carry a box where three would do: the direct solver's matrix is singular unless CFM is added to it.
BOOST_AUTO_TEST_CASE(as_shipped_the_direct_solver_throws_away_a_box_that_stands_on_another) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  for (const double z : {1.05, 0.0}) {
    Body box;
    box.name = z > 0 ? "above" : "below", box.shape = Box{{1, 1, 1}}, box.inertia = inertia_of(*box.shape, 1);
    box.position = {0, 0, z}, box.collides = true, box.fixed = z == 0;
    scene.bodies.push_back(box);
  }
  scene.contact_default = {0, kInfiniteFriction};
  const auto distance_after_2s = [&](Track track) {
    const auto world = BulletEngine().load(scene, {"mlcp", {}, track});
    for (int n = 0; n < 480; ++n) world->step(1.0 / 240);
    Snapshot snapshot;
    world->read(snapshot);
    return (snapshot.bodies().position(0) - Vec3(0, 0, 1)).norm();
  };
  BOOST_TEST(distance_after_2s(Track::stock) > 10);
  BOOST_TEST(distance_after_2s(Track::matched) < 0.005);  // a step's fall from the drop of 0.05 m
}

BOOST_AUTO_TEST_CASE(a_scene_with_a_joint_that_bullet_does_not_have_is_not_loaded) {
  Scene scene = asymmetric_top();
  scene.joints = {{kWorld, 0, DistanceJoint{{0, 0, 2}, {0, 0, 0}}}};
  BOOST_CHECK_THROW(BulletEngine().load(scene, {"sequential-impulse", {}, Track::matched}), InputError);
}

BOOST_AUTO_TEST_SUITE_END()
