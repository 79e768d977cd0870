// Laws of mechanics that need no truth: the same scene told in another way must move in the same way. Run over every
// engine, method and track.
//
// The allowed difference is rounding as magnified by the motion. Each step adds a few roundings of the numbers' size.
// Each rounding grows like a small change of the start, and growth() measures this growth.
#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "core/scene/contact_laws.h"
#include "core/scene/turned.h"
#include "tests/adapters/seam_runs.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_laws)

namespace {

constexpr double kStep = 1.0 / 120;  // s
constexpr int kSteps = 240;

States end_of(const Run& run, const Scene& scene, int steps = kSteps) {
  return states_of(state_after(*run.load(scene), kStep, steps));
}

// The largest difference in m, rad, m/s and rad/s.
double difference(const States& a, const States& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest =
        std::max({largest, (a[i].position - b[i].position).norm(), angle_between(a[i].orientation, b[i].orientation),
                  (a[i].velocity - b[i].velocity).norm(), (a[i].angular_velocity - b[i].angular_velocity).norm()});
  }
  return largest;
}

// The largest number in a state, at least the 1 of a unit quaternion.
double size_of(const States& states) {
  double largest = 1;
  for (const BodyState& s : states) {
    largest = std::max({largest, s.position.norm(), s.velocity.norm(), s.angular_velocity.norm()});
  }
  return largest;
}

// How many times larger a small change of the start is at the end.
double growth(const Run& run, const Scene& scene) {
  constexpr double kNudge = 1e-7;  // small enough to grow linearly, large beside the roundings
  Scene nudged = scene;
  for (std::size_t i = 0; i < nudged.bodies.size(); ++i) {
    const Vec3 nudge = kNudge * Vec3(1, i % 2 ? 1 : -1, 1);
    nudged.bodies[i].position += nudge;
    nudged.bodies[i].velocity += nudge;
    nudged.bodies[i].orientation = rotation_by(nudge) * nudged.bodies[i].orientation;
    nudged.bodies[i].angular_velocity += nudge;
  }
  return std::max(1.0, difference(end_of(run, scene), end_of(run, nudged)) / kNudge);
}

// One rounding of the numbers' size per step, magnified like the first one. The factor is twice the need of the longest
// steps, with fifteen stages, and ten times the need of the others.
double tolerance(const Run& run, const Scene& scene, double size, int steps = kSteps) {
  return std::numeric_limits<double>::epsilon() * size * steps * growth(run, scene);
}

struct Named {
  std::string name;
  Scene scene;
};

// Damped and driven; free; and tied to each other and nothing else.
std::vector<Named> smooth_scenes() {
  Scene pair = test::coupled_bodies(0);
  pair.springs.erase(pair.springs.begin());
  pair.forces.clear();
  return {{"coupled bodies", test::coupled_bodies(0.8)}, {"a free top", top()}, {"a free pair", pair}};
}

// Falls, slanting and spinning, on a tilted plane, and bounces; and two that meet in the air.
std::vector<Named> scenes_with_contacts() {
  Scene bounce = test::dropped_sphere(0.5);
  std::get<Plane>(*bounce.bodies[1].shape) = {Vec3(0.3, 1, -0.2).normalized(), -0.1};
  bounce.bodies[0].velocity = {0.4, -1, 0.3}, bounce.bodies[0].angular_velocity = {3, -1, 2};

  Scene meeting = test::dropped_sphere(0.8);
  meeting.bodies[1] = meeting.bodies[0];
  meeting.bodies[1].name = "other", meeting.bodies[1].position = {0.9, 1.52, 0.07};
  meeting.bodies[0].velocity = {1.1, 0.2, 0}, meeting.bodies[1].angular_velocity = {0, 2, -4};
  return {{"a bouncing sphere", bounce}, {"two spheres that meet", meeting}};
}

const Quat kTurn = rotation_by({0.7, -1.1, 0.4});
const Vec3 kShift = {30, -70, 50};  // m

Scene in_turned_world(Scene scene) { return turned(std::move(scene), kTurn); }

States turned_back(States states) {
  const Quat back = kTurn.conjugate();
  for (BodyState& s : states) {
    s = {back * s.position, back * s.orientation, back * s.velocity, back * s.angular_velocity};
  }
  return states;
}

Scene shifted(Scene scene) {
  for (Body& body : scene.bodies) {
    body.position += kShift;
    if (body.shape && std::holds_alternative<Plane>(*body.shape)) {
      auto& plane = std::get<Plane>(*body.shape);
      plane.offset += plane.normal.dot(kShift);
    }
  }
  for (Spring& spring : scene.springs) {
    if (spring.a == kWorld) spring.point_a += kShift;
    if (spring.b == kWorld) spring.point_b += kShift;
  }
  return scene;
}

States shifted_back(States states) {
  for (BodyState& s : states) s.position -= kShift;
  return states;
}

Scene scaled(Scene scene, double scale) {
  for (Body& body : scene.bodies) body.mass *= scale, body.inertia *= scale;
  for (Spring& spring : scene.springs) spring.stiffness *= scale, spring.damping *= scale;
  for (TimedForce& force : scene.forces) force.force *= scale, force.torque *= scale;
  return scene;
}
Scene heavier(Scene scene) { return scaled(std::move(scene), 3.1e6); }
Scene lighter(Scene scene) { return scaled(std::move(scene), 3.1e-6); }

// The bodies, springs and forces from last to first.
Scene reordered(Scene scene) {
  const int last = static_cast<int>(scene.bodies.size()) - 1;
  const auto moved = [&](int body) { return body == kWorld ? kWorld : last - body; };
  std::reverse(scene.bodies.begin(), scene.bodies.end());
  std::reverse(scene.springs.begin(), scene.springs.end());
  std::reverse(scene.forces.begin(), scene.forces.end());
  for (Spring& spring : scene.springs) spring.a = moved(spring.a), spring.b = moved(spring.b);
  for (TimedForce& force : scene.forces) force.body = moved(force.body);
  for (ContactPair& pair : scene.contact_pairs) pair.a = moved(pair.a), pair.b = moved(pair.b);
  return scene;
}

States reordered_back(States states) {
  std::reverse(states.begin(), states.end());
  return states;
}

States as_they_are(States states) { return states; }

// The scene that goes on from where a run is, backwards in time.
Scene reversed_from(Scene scene, const States& states) {
  for (std::size_t i = 0; i < states.size(); ++i) {
    Body& body = scene.bodies[i];
    body.position = states[i].position;
    body.orientation = states[i].orientation;
    body.velocity = -states[i].velocity;
    body.angular_velocity = -states[i].angular_velocity;
  }
  return scene;
}

struct Law {
  std::string name;
  Scene (*tell_otherwise)(Scene);
  States (*back)(States);
};

// What an engine is known to break, by how much at most, and why. Each is looked at too: a row that no longer holds is
// to go.
struct Exception {
  std::string law, engine, settings;
  bool touching;  // of the scenes with contacts, or of the smooth ones
  double most;    // m, rad, m/s, rad/s
  std::string because;
};
constexpr double kAnyAmount = std::numeric_limits<double>::infinity();
const char* const kCompliance =
    "its constraint force mixing, 1e-10, is a compliance in 1/kg: beside 1/m it counts for heavy bodies, and little "
    "for light ones";
const char* const kDirections =
    "its constraint force mixing, here 1e-10 of 1/m, makes what friction does depend by as much on the two directions "
    "that it is split into; after a first impact without sliding these are left to rounding";
constexpr double kMixing = 1e-9;  // ten times the mixing: a few impacts
const char* const kCutOff =
    "its exponential map is cut off below 1e-3 rad, for orientations as for turns, so that W's own axes are not like "
    "others (dart/README.md)";
const char* const kResidual = "as shipped its iteration ends at 1e-6 N s, whatever the masses are";
const std::vector<Exception> kExceptions = {
    {"larger masses", "siconos", "stock", false, 1e-4, kResidual},
    {"smaller masses", "siconos", "stock", false, 0.1, kResidual},
    {"turned frame", "dart", "", false, 1e-8, kCutOff},
    {"turned frame", "core:dart-twin", "", false, 1e-8, "does as DART does"},
    {"smaller masses", "bullet", "", false, kAnyAmount,
     "leaves out the gyroscopic torque of small moments of inertia (bullet_twin.cpp)"},
    {"smaller masses", "core:bullet-twin", "", false, kAnyAmount, "does as Bullet does"},
    {"larger masses", "ode", "stock", true, kAnyAmount, kCompliance},
    {"smaller masses", "ode", "stock", true, 1e-5, kCompliance},
    {"larger masses", "ode", "matched", true, kMixing, kDirections},
    {"smaller masses", "ode", "matched", true, kMixing, kDirections},
    {"shifted origin", "ode", "matched", true, kMixing, kDirections},
    {"turned frame", "ode", "matched", true, kMixing, kDirections},
};

const Exception* exception_for(const std::string& law, bool touching, const Run& run) {
  const auto row = std::find_if(kExceptions.begin(), kExceptions.end(), [&](const Exception& e) {
    return e.law == law && e.touching == touching && run.name().starts_with(e.engine) &&
           run.name().ends_with(e.settings);
  });
  return row == kExceptions.end() ? nullptr : &*row;
}

const std::vector<Law> kLaws = {
    {"larger masses", heavier, as_they_are},        {"other order of bodies", reordered, reordered_back},
    {"shifted origin", shifted, shifted_back},      {"smaller masses", lighter, as_they_are},
    {"turned frame", in_turned_world, turned_back},
};

}  // namespace

BOOST_AUTO_TEST_CASE(the_same_scene_told_in_another_way_moves_in_the_same_way) {
  std::set<const Exception*> needed;
  std::vector<Named> scenes = smooth_scenes();
  for (Named& named : scenes_with_contacts()) scenes.push_back(std::move(named));
  for (const auto& [scene_name, scene] : scenes) {
    const bool touching = anything_can_touch(scene);
    for (const Law& law : kLaws) {
      BOOST_TEST_CONTEXT(law.name << ", " << scene_name) {
        const Scene other = law.tell_otherwise(scene);
        for_each_run(scene, kStep, [&](const Run& run) {
          if (chooses_steps(run)) return;
          const States here = end_of(run, scene), there = end_of(run, other);
          const double size = std::max(size_of(here), size_of(there)), apart = difference(here, law.back(there));
          if (apart <= tolerance(run, scene, size)) return;
          const Exception* exception = exception_for(law.name, touching, run);
          BOOST_TEST((exception && apart <= exception->most), apart << " apart");
          needed.insert(exception);
        });
      }
    }
  }
  for (const Exception& e : kExceptions) {
    BOOST_TEST(needed.contains(&e), e.law << " is no longer broken by " << e.engine << " " << e.settings);
  }
}

BOOST_AUTO_TEST_CASE(a_symmetric_method_finds_its_way_back) {
  int checked = 0;
  for (const auto& [scene_name, damped] : smooth_scenes()) {
    Scene scene = damped;
    for (Spring& spring : scene.springs) spring.damping = 0;
    BOOST_TEST_CONTEXT(scene_name) {
      for_each_run(scene, kStep, [&](const Run& run) {
        if (!run.method().symmetric) return;
        const States there = end_of(run, scene);
        const States back = end_of(run, reversed_from(scene, there));
        const States start = states_of(state_of(*run.load(scene)));
        const States expected = states_of(state_of(*run.load(reversed_from(scene, start))));
        BOOST_TEST(difference(back, expected) <= tolerance(run, scene, size_of(there), 2 * kSteps));
        BOOST_TEST(difference(there, start) > 0.1);  // it has been somewhere
        ++checked;
      });
    }
  }
  BOOST_TEST(checked > 0, "no method says that it is symmetric");
}

BOOST_AUTO_TEST_SUITE_END()
