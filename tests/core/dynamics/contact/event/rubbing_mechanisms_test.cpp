// Mechanisms that nobody chose, which fall on a floor that rubs: every step ends, no energy grows, and the step does
// not matter.
#include <random>

#include "core/dynamics/joints/joints.h"
#include "core/dynamics/model/energy.h"
#include "core/engine/engine.h"
#include "tests/core/dynamics/contact/contact_runs.h"
#include "tests/core/dynamics/joints/jointed_run.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_event_rubbing_mechanisms)

namespace {

class Maker {
 public:
  explicit Maker(unsigned seed) : random_(seed) {}

  Scene scene() {
    constexpr double kHeight = 0.45;  // m
    const int size = 2 + static_cast<int>(between(0, 3));
    std::vector<Body> bodies;
    for (int i = 0; i < size; ++i) {
      const Vec3 from = i == 0 ? Vec3(0, 0, kHeight) : bodies[static_cast<std::size_t>(i) - 1].position;
      Vec3 way = 0.35 * vector().normalized();
      way.z() = std::abs(way.z());
      bodies.push_back(link(i == 0 ? from : Vec3(from + way)));
    }
    Scene scene = on_floor(std::move(bodies), {chance(0.3) ? 0.5 : 0, 0.2 + between(0, 0.6)});
    for (int i = 1; i < size; ++i)
      scene.joints.push_back(joint(i, 0.5 * (scene.bodies[i].position + scene.bodies[i - 1].position)));
    return scene;
  }

 private:
  double between(double a, double b) { return a + (b - a) * (static_cast<double>(random_()) / std::mt19937::max()); }
  bool chance(double share) { return between(0, 1) < share; }
  Vec3 vector() {
    const double x = between(-1, 1), y = between(-1, 1), z = between(-1, 1);
    return {x, y, z};
  }

  Body link(const Vec3& at) {
    const double kind = between(0, 1), mass = between(0.3, 3);
    const Shape shape = kind < 0.4   ? Shape(Sphere{between(0.05, 0.12)})
                        : kind < 0.7 ? Shape(Box{{0.12, between(0.08, 0.16), 0.1}})
                                     : Shape(Capsule{between(0.03, 0.06), between(0.05, 0.12)});
    Body body = solid("link", shape, at, mass);
    body.orientation = rotation_by(vector());
    return body;
  }

  Joint joint(int child, const Vec3& anchor) {
    Joint joint{child - 1, child, HingeJoint{anchor, vector().normalized()}};
    const double kind = between(0, 1);
    if (kind < 0.25) joint.type = BallJoint{anchor};
    if (kind > 0.75) joint.type = SliderJoint{vector().normalized()};
    if (kind < 0.25) return joint;
    if (chance(0.4)) joint.stiffness = 5, joint.rest = 0;
    if (chance(0.5)) joint.damping = between(0.02, 0.5);
    if (chance(0.4)) joint.lower = -between(0.1, 0.8), joint.upper = between(0.1, 0.8);
    return joint;
  }

  std::mt19937 random_;
};

constexpr double kEnd = 0.6;  // s

struct Fall {
  std::vector<BodyTable> at;  // every 1/60 s
  double gain = 0;            // of the energy above the least so far, of its size at first
  double gap = 0;             // m
  double crowded_from = kEnd;
};

// The world's own warning, as of a tolerance that is not met in 20000 inner steps, is an error.
Fall fall(const Scene& scene, double dt, const std::string& contact = "") {
  std::map<std::string, std::string> options;
  if (!contact.empty()) options["contact"] = contact;
  const auto world = CoreEngine().load(scene, {.method = "dormand-prince", .options = options});
  System system(scene);
  Joints joints(scene, system);
  Snapshot now;
  world->read(now);
  const double first = energy(scene, now.bodies());
  double least = first;
  Fall fall;
  for (int n = 1; n <= std::lround(60 * kEnd); ++n) {
    step_until(*world, dt, 1.0 / 60);
    world->read(now);
    const double joules = energy(scene, now.bodies());
    fall.gain = std::max(fall.gain, (joules - least) / std::abs(first)), least = std::min(least, joules);
    fall.gap = std::max(fall.gap, joints.gap(now.bodies()));
    fall.at.emplace_back(now.bodies());
  }
  if (const auto reduced = reduced_order_of(*world)) fall.crowded_from = reduced->from;
  return fall;
}

double apart(const Fall& one, const Fall& other, double until) {
  double most = 0;
  for (std::size_t n = 0; n < one.at.size() && static_cast<double>(n + 1) / 60 < until; ++n) {
    for (std::size_t i = 0; i < one.at[n].size(); ++i)
      most = std::max(most, difference(one.at[n].columns().body(i), other.at[n].columns().body(i)).pose);
  }
  return most;
}

}  // namespace

// Each inner step's tolerance is 1e-12 of the state, which impacts magnify; measured at most 1e-10 m. Crowded events
// are followed by first-order steps.
BOOST_AUTO_TEST_CASE(mechanisms_that_fall_and_rub_go_on_and_gain_nothing) {
  int rubbing = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const Scene scene = Maker(seed).scene();
    BOOST_TEST_CONTEXT("seed " << seed) {
      const Fall coarse = fall(scene, 1.0 / 240), fine = fall(scene, 1.0 / 480);
      const bool is_crowded = coarse.crowded_from < kEnd;
      BOOST_TEST(coarse.gain < (is_crowded ? 1e-4 : 1e-11));
      BOOST_TEST(coarse.gap < 1e-12);
      const double until = std::min(coarse.crowded_from, fine.crowded_from);
      BOOST_TEST(apart(coarse, fine, until) < 1e-8);
      rubbing += until > 0.4;
    }
  }
  BOOST_TEST(rubbing >= 20);
}

// Jointed bodies with friction on a floor use events by default.
BOOST_AUTO_TEST_CASE(events_are_what_rubbing_mechanisms_get_by_default) {
  const Scene scene = Maker(1).scene();
  BOOST_TEST(contact_method_for(scene).name == "event");
  BOOST_TEST(apart(fall(scene, 1.0 / 240), fall(scene, 1.0 / 240, "event"), kEnd) == 0.0);
}

// A body at 100 rad/s would rotate by three radians in a step of 1/30 s, in which rk4 loses all digits.
BOOST_AUTO_TEST_CASE(a_fast_link_is_not_thrown_about_by_coarse_steps) {
  Scene scene = on_floor({solid("hub", Sphere{0.1}, {0, 0, 5}, 2), solid("link", Box{{0.3, 0.05, 0.05}}, {0.25, 0, 5})},
                         {0, 0.5});
  scene.joints = {{.a = 0, .b = 1, .type = BallJoint{Vec3(0.1, 0, 5)}}};
  scene.bodies[1].collides = false;
  scene.bodies[1].angular_velocity = {0, 0, 100};
  scene.bodies[1].velocity = {0, 15, 0};
  const auto world = CoreEngine().load(scene, {.method = "rk4", .options = {}});
  Snapshot now;
  world->read(now);
  const double first = energy(scene, now.bodies());
  step_until(*world, 1.0 / 30, 0.5);
  world->read(now);
  // rk4 loses (w h)^6/72 = 3e-6 of the energy in a turn by a quarter of a radian, two hundred of which there are.
  BOOST_TEST(std::abs(energy(scene, now.bodies()) / first - 1) < 1e-3);
}

BOOST_AUTO_TEST_SUITE_END()
