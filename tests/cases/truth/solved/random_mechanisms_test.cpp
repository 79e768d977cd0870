// Random trees of joints with springs, dampers, limits and motors. The reference and the core share no code and must
// agree on the motion.
#include <boost/test/unit_test.hpp>
#include <random>

#include "cases/truth/truth.h"
#include "tests/cases/judged.h"
#include "tests/core/dynamics/joints/jointed_run.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_solved_random_mechanisms)

namespace {

class Maker {
 public:
  explicit Maker(unsigned seed) : random_(seed) {}

  Scene scene() {
    const int size = 2 + static_cast<int>(between(0, 4));
    for (int i = 0; i < size; ++i) add_link(i == 0 ? kWorld : static_cast<int>(between(0, i)));
    return scene_;
  }

 private:
  double between(double a, double b) { return a + (b - a) * (static_cast<double>(random_()) / std::mt19937::max()); }
  bool chance(double share) { return between(0, 1) < share; }
  Vec3 vector(double size) {
    const double x = between(-size, size), y = between(-size, size), z = between(-size, size);
    return {x, y, z};
  }

  void add_link(int parent) {
    const Vec3 base = parent == kWorld ? Vec3::Zero() : scene_.bodies[parent].position, at = base + vector(0.5);
    const double mass = std::pow(10, between(-1, 1));
    const Vec3 edges(between(0.05, 0.3), between(0.05, 0.3), between(0.05, 0.3)), squares = edges.cwiseAbs2();
    Body link = test::body("link", mass, mass / 3 * (Vec3::Constant(squares.sum()) - squares), at);
    link.orientation = Quat(Eigen::AngleAxisd(between(0, 3), vector(1).normalized()));
    scene_.bodies.push_back(link);
    const int self = static_cast<int>(scene_.bodies.size()) - 1;
    Joint joint{parent, self, HingeJoint{(at + base) / 2 + vector(0.1), vector(1).normalized()}};
    const double kind = between(0, 1);
    if (kind < 0.15) joint.type = BallJoint{(at + base) / 2};
    if (kind > 0.8) joint.type = SliderJoint{vector(1).normalized()};
    if (kind >= 0.15) load(joint, self);
    scene_.joints.push_back(joint);
  }

  // Springs, dampers and limits of a joint with an axis, and motors on it.
  void load(Joint& joint, int index) {
    if (chance(0.4)) joint.stiffness = 20, joint.rest = between(-0.3, 0.3);
    if (joint.stiffness > 0 && chance(0.5)) joint.quadratic_stiffness = 15;
    if (chance(0.4)) joint.damping = between(0.05, 1);
    if (chance(0.5)) joint.lower = -between(0, 0.8), joint.upper = between(0, 0.8);
    if (chance(0.5)) joint.restitution = 0.5;
    if (!chance(0.4)) return;
    Motor motor;
    motor.joint = index;
    motor.from = 0.1;
    chance(0.5) ? void(motor.effort = between(-3, 3)) : void(motor.speed = between(-2, 2));
    motor.most = between(0.5, 20);
    scene_.motors.push_back(motor);
  }

  std::mt19937 random_;
  Scene scene_;
};

}  // namespace

// dormand-prince keeps some 1e-12 in each step. At limits, a flight shorter than a thousandth of the step is suppressed
// (integrators/joint_events.cpp): 4 µs, in which 10 m/s² make 2e-5 m/s. A few of these per second leave 1e-6 m.
BOOST_AUTO_TEST_CASE(the_core_and_the_reference_tell_of_the_same_motion) {
  constexpr double kEnd = 0.5, kNoFlight = 2e-6, kSmooth = 1e-10;  // s, m
  int known = 0, with_limits = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const Scene scene = Maker(seed).scene();
    const auto truth = make_truth("reference", scene, kEnd);
    if (!(truth->error(kEnd) < 1e-10)) continue;  // it says itself that it does not know
    const bool has_limits =
        std::any_of(scene.joints.begin(), scene.joints.end(), [](const Joint& joint) { return joint.has_limits(); });
    ++known, with_limits += has_limits;
    const BodyTable core = test::state_after(scene, "dormand-prince", 1.0 / 240, kEnd),
                    expected = test::truth_at(*truth, kEnd, scene.bodies.size());
    double apart = 0;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      apart = std::max(apart, test::difference(core.columns().body(i), expected.columns().body(i)).pose);
    BOOST_TEST(apart < (has_limits ? kNoFlight : kSmooth) + 10 * truth->error(kEnd), "seed " << seed << ": " << apart);
  }
  BOOST_TEST(known >= 50);
  BOOST_TEST(with_limits >= 20);
}

BOOST_AUTO_TEST_SUITE_END()
