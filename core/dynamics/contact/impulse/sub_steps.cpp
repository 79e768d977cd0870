#include "core/dynamics/contact/impulse/sub_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/engine/option_values.h"

namespace rigor {
namespace {

// So short that what a spring as stiff as a sub-step allows gives way under ten bodies is a fraction of a millimetre.
// Steps longer than kCoarse are chosen for their small number, and leave time for more work in each; and bodies that
// weigh many times as much as others need it: of boxes in a pyramid on sub-steps of 1/480 s, a top of thirty or a
// hundred times the others' mass moves them by 5 mm at most, one of three hundred by up to 10 cm.
constexpr double kCoarse = 1.0 / 50, kLongestSubStep = 1.0 / 480, kShorterSubStep = 1.0 / 960;  // s
constexpr double kUnevenMassRatio = 30;
constexpr int kFewestSubSteps = 4;

constexpr double kDampingRatio = 10;              // zeta of the soft constraint
constexpr double kContactHertzPerSubStep = 0.25;  // its frequency, of that of the sub-steps
constexpr double kMaxPushSpeed = 3;               // m/s

// What comes together faster than gravity brings it in so many sub-steps is an impact.
constexpr double kSubStepsOfFall = 4;
constexpr int kMaxImpactSweeps = 30;       // over the points of an impact, of which few bodies have more than four
constexpr double kImpactTolerance = 1e-3;  // of the restitution threshold

bool has_uneven_masses(const Scene& scene) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const Body& body : scene.bodies) {
    if (!body.fixed && body.collides) least = std::min(least, body.mass), most = std::max(most, body.mass);
  }
  return most > kUnevenMassRatio * least;
}

}  // namespace

int rounded_up(double count) { return static_cast<int>(std::ceil(count - 1e-9)); }

// A semi-implicit method moves by the velocity after the sub-step, the others by the mean of both.
SubSteps::SubSteps(const Scene& scene, const ContactParts& parts)
    : given_(static_cast<int>(number_option(parts.settings, "substeps", 0))),
      longest_sub_step_(has_uneven_masses(scene) ? kShorterSubStep : kLongestSubStep),
      gravity_(scene.gravity.norm()),
      theta_(parts.integrator.leapfrog_stagger > 0 ? 1 : 0.5) {}

bool SubSteps::takes_impacts_at_once(const Settings& settings) {
  return word_option(settings, "impacts", "sequential") == "simultaneous";
}

int SubSteps::of(double dt) const {
  if (given_ > 0) return given_;
  return std::max(kFewestSubSteps, rounded_up(dt / (dt > kCoarse ? kShorterSubStep : longest_sub_step_)));
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
          .max_push_speed = kMaxPushSpeed,
          .restitution_threshold = threshold,
          .tolerance = kImpactTolerance * threshold,
          .max_sweeps = kMaxImpactSweeps};
}

SettingsInForce SubSteps::settings_in_force() const {
  return {{"contacts", fmt::format("found once a step and every 1/{:.0f} s", 1 / kContactUpdateInterval)},
          {"sub-steps",
           given_ > 0 ? fmt::format("{} a step", given_)
                      : fmt::format("at least {} a step, none longer than 1/{:.0f} s (1/{:.0f} s in steps over 1/50 s)",
                                    kFewestSubSteps, 1 / longest_sub_step_, 1 / kShorterSubStep)}};
}

}  // namespace rigor
