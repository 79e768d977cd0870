#include "cases/analysis/mistakes/probes.h"

#include <algorithm>
#include <cmath>

#include "core/scene/contact_laws.h"

namespace rigor::inline analysis {
namespace {

struct Row {
  const char* id;
  double duration;  // s: until the event that it is chosen for has happened
  bool is_of_points = false;
};

// Each mistake of the table changes the motion in some of these, and no two mistakes change it alike in all of them.
constexpr Row kRows[] = {
    {"ballistic/fast-spin", 0.6, true},
    {"ballistic/free-fall", 1.2, true},  // 5 m/s after 0.5 s, a hundred steps after 1 s
    {"ballistic/projectile", 1, true},   // tilted, moving and spinning
    {"contact/bounce-half", 0.7},        // its first impact at 0.45 s
    {"contact/capsules-end-on", 0.8},
    {"contact/collision", 0.8},  // at 0.53 s
    {"contact/friction-fan", 0.6},
    {"contact/lying-still", 0.3},
    {"contact/pair-impact-0.5", 1.6},  // at 1 s
    {"contact/slide-to-roll", 1.2},    // rolls from 0.97 s on
    {"contact/sliding-stop", 1.2},     // stops at 1.02 s
    {"contact/slope-slides", 0.6},
    {"contact/sphere-stack", 0.5},  // five on each other: where surfaces are adds up; at rest after 0.3 s
    {"forces/compass-needle", 1.2},
    {"forces/switches-inside-steps", 3, true},  // the last of its forces ends at 2.72 s
    {"forces/torqued-top", 1.6},                // its torque begins at 1 s
    {"joints/chrono-revolute", 1},
    {"joints/pendulum-90", 1},
    {"springs/body-springs", 1},
    {"springs/fixed-spring", 1},
    {"springs/hung-part", 1},
    {"springs/mass-ratio", 1},
    {"springs/oscillator", 1.2, true},
    {"springs/oscillator-overdamped", 2, true},  // slower than 5 cm/s after 1.6 s
    {"springs/oscillator-underdamped", 1.2, true},
    {"springs/two-bodies", 1, true},
    {"tops/asymmetric-top", 1},
    {"tops/dzhanibekov-box", 1},
    {"tops/off-diagonal-inertia", 1},
};

// 1/60 s is itself a mistake of the table. An engine may meet each impact up to a step late, so bodies that touch get
// shorter steps.
double step_for(const Scene& scene) { return anything_can_touch(scene) ? 1.0 / 500 : 1.0 / 100; }

// rad/s or 1/s: no spring or damper of the scene makes a faster motion. Each acts on its bodies alone, at the full arm.
double fastest_rate(const Scene& scene) {
  double fastest = 0;
  for (const Spring& spring : scene.springs) {
    double mobility = 0;  // 1/kg
    for (const auto& [body, point] : {std::pair(spring.a, spring.point_a), std::pair(spring.b, spring.point_b)}) {
      if (body == kWorld || scene.bodies[static_cast<std::size_t>(body)].fixed) continue;
      const Body& moving = scene.bodies[static_cast<std::size_t>(body)];
      mobility += 1 / moving.mass + point.squaredNorm() * moving.inertia.inverse().norm();
    }
    const double stiffness = stiffness_at(spring, scene.extension_at_start(spring));
    fastest = std::max({fastest, spring.damping * mobility, std::sqrt(stiffness * mobility)});
  }
  return fastest;
}

// Extrapolation from three steps needs steps that resolve the motion, also that of a mistake that is twice as stiff.
double resolving_step(const Scene& scene) {
  constexpr double kOfRate = 0.2, kShortest = 1e-4;
  const double rate = fastest_rate(scene);
  return std::min(step_for(scene), rate > 0 ? std::max(kShortest, kOfRate / rate) : HUGE_VAL);
}

ProbeScene probe_of(const Case& definition, double dt, double duration) {
  ProbeScene probe{definition.id, std::make_shared<Scene>(definition.scene)};
  probe.dt = dt, probe.duration = std::min(duration, definition.duration);
  return probe;
}

}  // namespace

std::vector<ProbeScene> probes_of_suite(const Vocabulary& vocabulary) {
  std::vector<ProbeScene> probes;
  for (const Row& row : kRows) {
    const Case definition = select_cases({row.id}, default_suite_dir(), vocabulary).front();
    probes.push_back(probe_of(definition, step_for(definition.scene), row.duration));
    probes.back().is_of_points = row.is_of_points;
  }
  return probes;
}

std::vector<ProbeScene> probes_of(const std::vector<Case>& cases) {
  constexpr double kMostBodySteps = 600;  // some milliseconds of the core
  std::vector<ProbeScene> probes;
  for (const Case& definition : cases) {
    const double steps = std::max(20.0, kMostBodySteps / static_cast<double>(definition.scene.bodies.size()));
    const double dt = resolving_step(definition.scene);
    probes.push_back(probe_of(definition, dt, steps * dt));
  }
  return probes;
}

}  // namespace rigor::inline analysis
