// The motion of a scene with contacts for which there is no closed form, by the core's contact by events. It is solved
// in several ways (events_solver.h): the finest is the truth, and the distance of the others is its error. A solution
// is computed once and kept (solution_cache.h).
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <utility>

#include "cases/truth/provenance.h"
#include "cases/truth/solved/events/events_solver.h"
#include "cases/truth/solved/solution_cache.h"
#include "cases/truth/truth.h"
#include "core/base/error.h"
#include "core/dynamics/contact/contact_method.h"
#include "core/dynamics/contact/event/impacts.h"
#include "core/scene/contact_laws.h"
#include "core/world.h"

namespace rigor::inline truth {
namespace {

// In the scene's units of speed: below the restitution threshold of the truth's run a body lies still.
constexpr double kAtRest = kRestitutionThreshold;

ReferenceSolution events_solution(const Scene& scene, double duration) {
  return kept_or_solved(events_content(scene, duration), [&] { return solve_events(scene, duration); });
}

class Events final : public Truth {
 public:
  Events(const Scene& scene, double duration)
      : scene_(scene), scales_(contact_scales(scene)), solution_(events_solution(scene, duration)) {}

  void at(double t, MutableBodyColumns out) const override {
    state_at(solution_, scene_, t, out);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double spin = scales_.length * out.angular_velocity(i).norm();
      if (std::max(out.velocity(i).norm(), spin) > kAtRest * scales_.speed()) continue;
      out.set_velocity(i, Vec3::Zero());
      out.set_angular_velocity(i, Vec3::Zero());
    }
  }

  double error(double t) const override {
    const auto next = std::lower_bound(solution_.error_times.begin(), solution_.error_times.end(), t);
    if (next != solution_.error_times.end()) return solution_.errors[next - solution_.error_times.begin()];
    // The last node is the duration but for the rounding of steps that are added up.
    const bool is_end = t <= solution_.error_times.back() * (1 + 1e-12);
    return is_end ? solution_.errors.back() : std::numeric_limits<double>::infinity();
  }

  std::string caveat() const override {
    if (solution_.ties.empty()) return "";
    const ContactTie& tie = solution_.ties.front();
    std::string pairs;
    for (const auto& [a, b] : tie.pairs)
      pairs += fmt::format("{}'{}' and '{}'", pairs.empty() ? "" : ", ", scene_.body_name(a), scene_.body_name(b));
    return fmt::format(
        "At {:.4g} s several pairs meet in one instant: {}. Which pair meets first decides what follows.", tie.time,
        pairs);
  }

 private:
  Scene scene_;
  ContactScales scales_;
  ReferenceSolution solution_;
};

// Whether the run is one of the core's with this contact, asked for or by default.
bool is_by_events(const RunName& run, const Scene& scene) {
  const auto& options = run.settings.options;
  if (run.engine != core_info().name) return false;
  return options.contains("contact") ? options.at("contact") == "event" : contact_method_for(scene).name == "event";
}

// The supported features beside contacts, limits and motors of given speed.
const Features kWhatAnyMethodTakes = {Feature::fixed_body,          Feature::quadratic_spring,
                                      Feature::joint_damper,        Feature::joint_spring,
                                      joint_feature<BallJoint>(),   joint_feature<DistanceJoint>(),
                                      joint_feature<FixedJoint>(),  joint_feature<HingeJoint>(),
                                      joint_feature<SliderJoint>(), joint_feature<UniversalJoint>(),
                                      Feature::joints_with_dampers, Feature::motor_effort,
                                      Feature::joint_friction,      Feature::spring,
                                      Feature::timed_force};

// A solution that is taken up between two of its nodes knows a hinge's angle, but not how often it has turned round.
bool may_pass_half_a_turn_from_a_limit(const Joint& joint) {
  if (!joint.has_limits() || !std::holds_alternative<HingeJoint>(joint.type)) return false;
  return joint.lower <= -std::numbers::pi || joint.upper >= std::numbers::pi;
}

std::unique_ptr<Truth> make_events(const Scene& scene, double duration) {
  if (!anything_can_touch(scene))
    throw InputError("the truth 'events' is for scenes with contacts; in this one nothing can touch: take 'reference'");
  for (const Need& need : needs_of(scene)) {
    if (kWhatAnyMethodTakes.contains(need.feature) || contact_method("event").features.contains(need.feature)) continue;
    throw InputError(fmt::format("the truth 'events' is for what contact by events expresses; this scene has {}: {}",
                                 word_of(need.feature), need.because));
  }
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    if (may_pass_half_a_turn_from_a_limit(scene.joints[k]))
      throw InputError(
          fmt::format("the truth 'events' is for hinges with two limits within half a turn, or none, for "
                      "it does not count turns; this scene has {} with others",
                      scene.joint_name(k)));
  }
  return std::make_unique<Events>(scene, duration);
}

}  // namespace

Provenance events_provenance() {
  return {
      "events",
      "solved by the core's own contact=event, in steps and integrators that differ: independent of every engine but "
      "the core; it shares collision detection and joints with the core's other runs; it does not judge runs by "
      "contact=event, with which it shares everything",
      is_by_events};
}

TruthRow events_truth() {
  return {"events",
          "a scene with contacts by the core's contact by events, in several ways: the difference is its error",
          make_events};
}

}  // namespace rigor::inline truth
