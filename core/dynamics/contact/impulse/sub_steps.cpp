#include "core/dynamics/contact/impulse/sub_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/engine/option_values.h"

namespace rigor::inline dynamics {
namespace {

// In units of the scene's time sqrt(L/g), so that equal scenes in other units get equal sub-steps. A stack of n bodies
// sags by n g h²/2.5 at its foot: with kLongestSubStep, by 2e-4 n of a body's half-length.
constexpr double kLongestSubStep = 0.023;
// Bodies that weigh many times as much as others need shorter ones. A pyramid of 1 m boxes was tried with a heavy top,
// on sub-steps of 1/480 s. With thirty or a hundred times the others' mass, it moves them by 5 mm at most. With three
// hundred times it moves them by up to 10 cm. At 1/960 s the order of the contacts decided whether it moves them by 3
// mm or 12 cm, at 1/1440 s it is 2 mm.
constexpr double kShorterSubStep = 0.0031, kUnevenMassRatio = 30;
constexpr int kFewestSubSteps = 4;
// Without gravity nothing but impacts sets a time. The count then bounds the time from an impact to the end of its
// sub-step, in which bodies move with velocities of before: of 16, to a sixteenth of a step.
constexpr int kFewestSubStepsWithoutGravity = 16;
// A longer step is chosen for the small number of steps, and leaves time for more work in each.
constexpr double kCoarse = 0.1, kLongestSubStepOfCoarse = 0.0116;
constexpr int kFewestSubStepsOfCoarse = 32, kFewestUpdatesOfCoarse = 4;
constexpr double kContactUpdateInterval = 0.1;

constexpr double kDampingRatio = 10;              // zeta of the soft constraint
constexpr double kContactHertzPerSubStep = 0.25;  // its frequency, of that of the sub-steps
constexpr double kMaxPushSpeed = 2;               // of the scene's speed sqrt(g L); no bound where it has none
// Of the scene's length: a smaller gap is none. A point that lands closes its gap to zero but for rounding, and
// rounding must not decide whether the next sub-step takes it for soft.
constexpr double kTouching = 1e-10;

// An approach faster than gravity causes in this many sub-steps is an impact.
constexpr double kSubStepsOfFall = 4;
constexpr int kMaxImpactSweeps = 30;       // over the points of an impact, of which few bodies have more than four
constexpr double kImpactTolerance = 1e-3;  // of the restitution threshold
// As a share of the tolerance of impacts: 4e-8 of the speed that gravity gives within a sub-step. What is left rocks a
// stack for a while. Ten boxes need 40,000 sweeps over their 40 points.
constexpr double kShareAtRest = 1e-5;
constexpr std::size_t kMostAtStart = 3000000;  // points times sweeps: less than 0.1 s

// Without gravity: the acceleration by which the fastest speed counts, in v²/L.
constexpr double kShareOfSpeed = 0.01;

// m/s²; a moment counts by the torque's acceleration of a point at the distance `length`.
double largest_load(const Scene& scene, double length) {
  double most = 0;
  const auto add = [&](int body, double force) {
    if (body != kWorld && !scene.bodies[static_cast<std::size_t>(body)].fixed)
      most = std::max(most, force / scene.bodies[static_cast<std::size_t>(body)].mass);
  };
  for (const TimedForce& force : scene.forces) add(force.body, force.force.norm() + force.torque.norm() / length);
  for (const Spring& spring : scene.springs) {
    for (const int body : {spring.a, spring.b}) add(body, elastic_effort(spring, length));
  }
  return most;
}

bool has_uneven_masses(const Scene& scene) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const Body& body : scene.bodies) {
    if (!body.fixed && body.collides) least = std::min(least, body.mass), most = std::max(most, body.mass);
  }
  return most > kUnevenMassRatio * least;
}

}  // namespace

SceneScales scales_of(const Scene& scene) {
  double sum = 0, fastest = 0;
  int count = 0;
  for (const Body& body : scene.bodies) {
    if (body.fixed || !body.collides) continue;
    sum += 0.5 * std::cbrt(volume_of(*body.shape)), ++count;
  }
  const double length = count > 0 ? sum / count : 1;
  for (const Body& body : scene.bodies) {
    if (!body.fixed) fastest = std::max(fastest, body.velocity.norm() + length * body.angular_velocity.norm());
  }
  double acceleration = scene.gravity.norm();
  if (acceleration == 0) acceleration = kShareOfSpeed * fastest * fastest / length;
  if (acceleration == 0) acceleration = largest_load(scene, length);
  return {length, std::sqrt(length / acceleration)};
}

int rounded_up(double count) { return static_cast<int>(std::ceil(count - 1e-9)); }

// A semi-implicit method moves by the velocity after the sub-step, the others by the mean of both.
SubSteps::SubSteps(const Scene& scene, const ContactParts& parts)
    : given_(static_cast<int>(number_option(parts.settings, kSubStepsOption, 0))),
      scales_(scales_of(scene)),
      longest_sub_step_(has_uneven_masses(scene) ? kShorterSubStep : kLongestSubStep),
      gravity_(scene.gravity.norm()),
      theta_(parts.integrator.leapfrog_stagger > 0 ? 1 : 0.5) {}

bool SubSteps::takes_impacts_at_once(const Settings& settings) {
  return word_option(settings, kImpactsOption) == "simultaneous";
}

int SubSteps::of(double dt) const {
  if (given_ > 0) return given_;
  const double length = dt / scales_.time;
  const int fewest = gravity_ > 0 ? kFewestSubSteps : kFewestSubStepsWithoutGravity;
  if (length <= kCoarse) return std::max(fewest, rounded_up(length / longest_sub_step_));
  return std::max(kFewestSubStepsOfCoarse, rounded_up(length / std::min(longest_sub_step_, kLongestSubStepOfCoarse)));
}

int SubSteps::contact_updates(double dt, int count) const {
  const double length = dt / scales_.time;
  const int fewest = length <= kCoarse ? 1 : kFewestUpdatesOfCoarse;
  return std::min(count, std::max(fewest, rounded_up(length / kContactUpdateInterval)));
}

// The soft constraint of frequency f and damping ratio zeta, omega = 2 pi f, integrated implicitly over h:
//   bias_rate = omega / (2 zeta + h omega),  mass_scale = a / (1 + a),  impulse_scale = 1 / (1 + a),
// with a = h omega (2 zeta + h omega).
SolverParameters SubSteps::parameters(double h) const {
  const double h_omega = 2 * std::numbers::pi * kContactHertzPerSubStep;
  const double a1 = 2 * kDampingRatio + h_omega, a2 = h_omega * a1;
  const double threshold = kSubStepsOfFall * h * gravity_;
  return {.h = h,
          .theta = theta_,
          .bias_rate = h_omega / (h * a1),
          .mass_scale = a2 / (1 + a2),
          .impulse_scale = 1 / (1 + a2),
          .max_push_speed = std::isinf(scales_.time) ? scales_.time : kMaxPushSpeed * scales_.speed(),
          .touching = kTouching * scales_.length,
          .restitution_threshold = threshold,
          .tolerance = kImpactTolerance * threshold,
          .max_sweeps = kMaxImpactSweeps};
}

SolverParameters SubSteps::until_at_rest(SolverParameters parameters, std::size_t constraints) {
  parameters.tolerance *= kShareAtRest;
  parameters.touching = -parameters.touching;
  parameters.max_sweeps = static_cast<int>(kMostAtStart / std::max<std::size_t>(constraints, 1));
  return parameters;
}

SettingsInForce SubSteps::settings_in_force() const {
  const double longest = longest_sub_step_ * scales_.time, coarse = kCoarse * scales_.time;
  const std::string by_default =
      std::isinf(scales_.time)
          ? fmt::format("{} a step", kFewestSubSteps)
          : fmt::format("at least {} a step, none longer than {:.3g} s; more in steps over {:.3g} s", kFewestSubSteps,
                        longest, coarse);
  return {{"contacts", std::isinf(scales_.time) ? "found once a step"
                                                : fmt::format("found once a step and every {:.3g} s",
                                                              kContactUpdateInterval * scales_.time)},
          {"sub-steps", given_ > 0 ? fmt::format("{} a step", given_) : by_default}};
}

}  // namespace rigor::inline dynamics
