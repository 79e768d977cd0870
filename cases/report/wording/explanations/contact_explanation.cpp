#include "cases/report/wording/explanations/contact_explanation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rigor::inline report {
namespace {

// The step at which a diagnosis has its value.
const StepSize& step_of_value(const Diagnosis& found) {
  for (const auto& [dt, value] : found.over) {
    if (value == found.value) return dt;
  }
  return found.over.front().first;
}

std::string overlap_text(const Results& results, const Diagnosis& found, const std::string& name, Claims& claims) {
  const StepSize& dt = found.over.front().first;
  return fmt::format(
      "Why: {} pushes an overlap out as speed. After an impact without bounce bodies part at {} of their approach "
      "speed, "
      "at dt = {} s.",
      name, claims.percent(claim_of(results, found, dt, "worst found of restitution_error", found.value)), dt.text);
}

std::string unconverged_text(const Results& results, const Diagnosis& found, const std::string& name, Claims& claims) {
  Claim grows = claim_of(results, found, step_of_value(found), "restitution_error", found.value);
  grows.relation = Relation::above, grows.bound = found.over.front().second;
  claims.state(grows);
  return fmt::format("Why: the restitution error of {} does not fall with dt: {}.", name,
                     text_over_steps(results, found, "restitution_error", "", claims));
}

std::string friction_text(const Results& results, const Diagnosis& found, const std::string& name, Claims& claims) {
  const StepSize& dt = step_of_value(found);
  return fmt::format(
      "Why: the friction of {} depends on direction. Stopping distances that should be equal differ by {} at dt = {} "
      "s. "
      "The worst body stops after {} instead of {}.",
      name, claims.percent(claim_of(results, found, dt, "friction_anisotropy", found.value)), dt.text,
      claims.quantity(claim_of(results, found, dt, "worst found of friction_anisotropy", found.worst.found), "m"),
      claims.quantity(claim_of(results, found, dt, "worst expected of friction_anisotropy", found.worst.expected),
                      "m"));
}

// Whether the excess of the force times dt, an impulse, is about the same at the two finest steps.
bool has_the_impulse_of_a_recovery(const Diagnosis& found) {
  constexpr double kAlike = 2;
  if (found.over.size() < 2) return false;
  const auto impulse = [](const std::pair<StepSize, double>& at) { return (at.second - 1) * at.first.seconds; };
  const double coarse = impulse(found.over[found.over.size() - 2]), fine = impulse(found.over.back());
  return coarse > 0 && fine > 0 && std::max(coarse, fine) <= kAlike * std::min(coarse, fine);
}

std::string spikes_text(const Results& results, const Diagnosis& found, const std::string& name, Claims& claims) {
  const StepSize& dt = step_of_value(found);
  const std::string text = fmt::format(
      "Why: the contact force of {} at rest grows as dt falls. The largest, over that of rest: {}. At dt = {} s it is "
      "{} in place of {}.",
      name, text_over_steps(results, found, "force_peak", "", claims), dt.text,
      claims.quantity(claim_of(results, found, dt, "worst found of force_peak", found.worst.found), "N"),
      claims.quantity(claim_of(results, found, dt, "worst expected of force_peak", found.worst.expected), "N"));
  if (!has_the_impulse_of_a_recovery(found)) return text;
  return text +
         " Its impulse hardly depends on dt, as of an overlap that is pushed out within one step. Correct less of an "
         "overlap in a step, or limit its speed.";
}

std::string creep_text(const Results& results, const Diagnosis& found, const std::string& name, Claims& claims) {
  const StepSize& dt = found.over.back().first;
  return fmt::format(
      "Why: the friction of {} holds no body at rest. At the end a body is {} from its place, at dt = {} s. If "
      "friction is regularised, it gives way at a steady speed, however hard the bodies press. Make friction stiffer "
      "then.",
      name, claims.quantity(claim_of(results, found, dt, "creep", found.value), "m"), dt.text);
}

std::string hover_text(const Results& results, const Diagnosis& found, const std::string& name, Claims& claims) {
  return fmt::format(
      "Why: bodies of {} press on each other across a gap. The mean gap under load: {}. Friction that is solved "
      "with the normal force can lift a sliding body by dt mu v. Take a smaller step.",
      name, text_over_steps(results, found, "hover", "m", claims));
}

std::string missing_text(const Results& results, const Diagnosis& found, const std::string& name, Claims& claims) {
  const StepSize& dt = found.over.back().first;
  return fmt::format(
      "Why: the contact forces that {} reports do not explain the motion. They leave {} unexplained at dt = {} s. The "
      "motion itself may be right.",
      name, claims.quantity(claim_of(results, found, dt, "contact_balance", found.value), "N"), dt.text);
}

std::string text_of_topic(const Results& results, const Diagnosis& found, const std::string& name, Claims& claims) {
  if (found.topic == kOverlapGivenBack) return overlap_text(results, found, name, claims);
  if (found.topic == kUnconverged) return unconverged_text(results, found, name, claims);
  if (found.topic == kForceSpikes) return spikes_text(results, found, name, claims);
  if (found.topic == kCreeps) return creep_text(results, found, name, claims);
  if (found.topic == kHovers) return hover_text(results, found, name, claims);
  if (found.topic == kForcesMissing) return missing_text(results, found, name, claims);
  return friction_text(results, found, name, claims);
}

}  // namespace

Claim claim_of(const Results& results, const Diagnosis& found, const StepSize& dt, const std::string& quantity,
               double value) {
  return {quantity, found.of_case, results.runs[found.runs.front()].text, dt.text, "", value};
}

std::string text_over_steps(const Results& results, const Diagnosis& found, const std::string& metric,
                            const std::string& unit, Claims& claims) {
  std::string list;
  for (const auto& [dt, value] : found.over) {
    list += fmt::format("{}{} at {}{} s", list.empty() ? "" : ", ",
                        claims.quantity(claim_of(results, found, dt, metric, value), unit), list.empty() ? "dt = " : "",
                        dt.text);
  }
  return list;
}

std::vector<Message> contact_explanations(const Results& results, const CaseResult& result) {
  std::vector<Message> messages;
  for (const Diagnosis& found : contact_diagnoses(result)) {
    const std::string& name = results.runs[found.runs.front()].text;
    Claims claims;
    const std::string text = text_of_topic(results, found, name, claims);
    messages.push_back({found.topic, found.cause.empty() ? text : text + " " + found.cause, "", claims.take()});
  }
  return messages;
}

}  // namespace rigor::inline report
