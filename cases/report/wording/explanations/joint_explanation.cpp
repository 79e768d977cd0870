#include "cases/report/wording/explanations/joint_explanation.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "cases/report/wording/cell_claim.h"
#include "cases/report/wording/explanations/contact_explanation.h"
#include "cases/report/wording/wording.h"

namespace rigor::inline report {
namespace {

// The number at the beginning of a text; not a number if there is none.
double leading_number(const std::string& text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() ? number : std::nan("");
}

// The share of a gap that a step closes, as the engine's setting states it.
double share_closed(const Diagnosis& found) {
  const std::string marker = "\"erp\": ";
  const auto at = found.cause.find(marker);
  return at == std::string::npos ? std::nan("") : leading_number(found.cause.substr(at + marker.size()));
}

class JointReasons {
 public:
  JointReasons(const Results& results, const CaseResult& result) : results_(results), result_(result) {}

  // Runs with the same numbers share a message.
  std::vector<Message> messages() {
    if (auto singular = singular_positions()) messages_.push_back(std::move(*singular));
    std::vector<std::pair<Message, std::string>> shared;  // with kName in place of the names, and the names
    for (const Diagnosis& found : joint_diagnoses(results_, result_)) {
      Claims claims;
      std::string text = found.topic == kJointsPart         ? text_of_gap(found, claims)
                         : found.topic == kJointsTakeEnergy ? text_of_energy(found, claims)
                                                            : text_of_chain(found, claims);
      if (!found.cause.empty()) text += " " + found.cause;
      const std::string& name = results_.runs[found.runs.front()].text;
      const auto same =
          std::find_if(shared.begin(), shared.end(), [&](const auto& one) { return one.first.text == text; });
      if (same == shared.end()) {
        shared.push_back({{found.topic, text, "", claims.take()}, name});
        continue;
      }
      same->second += ", " + name;
      for (Claim& one : claims.take()) same->first.claims.push_back(std::move(one));
    }
    for (auto& [message, names] : shared) {
      message.text.replace(message.text.find(kName), std::string(kName).size(), names);
      messages_.push_back(std::move(message));
    }
    return std::move(messages_);
  }

 private:
  static constexpr const char* kName = "\x01";

  Claim claim(const Diagnosis& found, const std::string& quantity, double value) const {
    return claim_of(results_, found, found.over.front().first, quantity, value);
  }

  // A step opens a joint by the same amount, of second order in dt, and closes a share of the gap. The gap that stands
  // is the amount over the share.
  std::string standing_gap(const Diagnosis& found, Claims& claims) const {
    constexpr double kLeast = 1.6, kMost = 2.4;  // order
    const double share = share_closed(found);
    if (!(share > 0 && share < 1) || found.over.size() < 2) return "";
    const auto& [coarse, at_coarse] = found.over[0];
    const auto& [finer, at_finer] = found.over[1];
    const double order = std::log(at_coarse / at_finer) / std::log(coarse.seconds / finer.seconds);
    if (!(order > kLeast && order < kMost)) return "";
    return fmt::format(" Each step closes {} of a gap, so {} openings of {} add up.",
                       claims.percent(claim(found, "gap closed by one step", share)),
                       claims.quantity(claim(found, "steps that stand", 1 / share), ""),
                       claims.quantity(claim(found, "gap opened by one step", share * found.value), "m"));
  }

  std::string text_of_gap(const Diagnosis& found, Claims& claims) const {
    constexpr double kGrows = 3;
    const bool grows = found.beside > 0 && found.value > kGrows * found.beside;
    std::string text = fmt::format(
        "Why: joints of {} come apart, most the {}: {}.", kName,
        found.worst.component.starts_with("gap of the ") ? found.worst.component.substr(11) : found.worst.component,
        text_over_steps(results_, found, "joint_gap", "m", claims));
    if (!grows) return text + standing_gap(found, claims);
    Claim first = claim(found, "first second of joint_gap", found.beside);
    first.relation = Relation::below, first.bound = found.value / kGrows;
    return text + fmt::format(" The gap grows with time: {} within the first second.", claims.quantity(first, "m"));
  }

  std::string text_of_chain(const Diagnosis& found, Claims& claims) const {
    constexpr double kUneven = 1.5;
    const Scene& scene = result_.definition.scene;
    const double ratio = mass_ratio(scene);
    const std::string& other = results_.runs[found.runs[1]].text;
    Claim of_other = claim(found, "joint_gap", found.beside);
    of_other.of_run = other, of_other.relation = Relation::below, of_other.bound = found.value;
    std::string text = fmt::format(
        "Why: the sweeps of {} from joint to joint stretch {} joints in a row by {} at dt = {} s. {} leaves {}. One "
        "sweep "
        "carries a load on by one joint.",
        kName, claims.count(claim_of_scene(result_, "joints in a row", joints_in_a_row(scene))),
        claims.quantity(claim(found, "joint_gap", found.value), "m"), found.over.front().first.text, other,
        claims.quantity(of_other, "m"));
    if (ratio > kUneven)
      text += fmt::format(" Masses up to {} : 1 slow it down further.",
                          claims.printed(claim_of_scene(result_, "mass ratio", ratio), three_digits(ratio)));
    return text;
  }

  std::string text_of_energy(const Diagnosis& found, Claims& claims) const {
    std::string list;
    for (const auto& [dt, value] : found.over) {
      list += fmt::format("{}{} at {}{} s", list.empty() ? "" : ", ",
                          claims.percent(claim_of(results_, found, dt, "energy_drift_synchronised", value)),
                          list.empty() ? "dt = " : "", dt.text);
    }
    return fmt::format(
        "Why: joints of {} lose energy that they should keep: {}. The loss falls as dt to the power {}. A step turns "
        "velocities onto the joints as they stand at its beginning; the part across them is lost.",
        kName, list, claims.quantity(claim(found, "order of energy_drift_synchronised", found.beside), ""));
  }

  static std::string reported_positions(const Cell& cell) {
    for (const auto& [key, value] : cell.settings) {
      if (key == "singular positions") return value;
    }
    return "";
  }

  bool is_finest_of_its_run(const Cell& cell) const {
    return std::none_of(result_.cells.begin(), result_.cells.end(), [&](const Cell& other) {
      return other.run == cell.run && !other.metrics.empty() && other.dt.seconds < cell.dt.seconds;
    });
  }

  // A singular position belongs to the mechanism, so the finest step of a run sees it too. A coarse step may take a
  // position near one for it.
  std::optional<Message> singular_positions() const {
    const Cell* finest = nullptr;
    for (const Cell& cell : result_.cells) {
      if (reported_positions(cell).empty() || !is_finest_of_its_run(cell)) continue;
      if (!finest || cell.dt.seconds < finest->dt.seconds) finest = &cell;
    }
    if (!finest) return {};
    const std::string times = reported_positions(*finest);
    return Message{
        "singular position",
        fmt::format(
            "Why: the joints pass a singular position {} ({}, dt = {} s). Another motion branches off there. Each "
            "run's own error decides which one it follows.",
            times, results_.runs[finest->run].text, finest->dt.text),
        "",
        {claim_of_cell(results_, result_, *finest, "singular position reported", 1)}};
  }

  const Results& results_;
  const CaseResult& result_;
  std::vector<Message> messages_;
};

}  // namespace

std::vector<Message> joint_explanations(const Results& results, const CaseResult& result) {
  return JointReasons(results, result).messages();
}

}  // namespace rigor::inline report
