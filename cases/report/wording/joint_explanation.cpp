#include "cases/report/wording/joint_explanation.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "cases/report/wording/contact_explanation.h"

namespace rigor {
namespace {

// The number that an engine's words begin with; not one if they begin with none.
double leading_number(const std::string& words) {
  double number = 0;
  const auto [end, error] = std::from_chars(words.data(), words.data() + words.size(), number);
  return error == std::errc() ? number : std::nan("");
}

// Where each step opens a joint by the same, of second order in dt, and closes a share of its gap, what stands is the
// one over the other.
std::string standing_gap(const Diagnosis& found, double share) {
  constexpr double kLeast = 1.6, kMost = 2.4;  // order
  if (!(share > 0 && share < 1) || found.over.size() < 2) return "";
  const auto& [coarse, at_coarse] = found.over[0];
  const auto& [finer, at_finer] = found.over[1];
  const double order = std::log(at_coarse / at_finer) / std::log(coarse.seconds / finer.seconds);
  if (!(order > kLeast && order < kMost)) return "";
  return fmt::format(" A step takes back {:g} of a gap, so that what stands is what {:.3g} steps open, {:.2g} m each.",
                     share, 1 / share, share * found.value);
}

std::string text_of_gap(const Diagnosis& found, const std::string& names) {
  constexpr double kGrows = 3;
  const bool grows = found.beside > 0 && found.value > kGrows * found.beside;
  const std::string marker = "\"erp\": ";
  const auto at = found.cause.find(marker);
  const double share = at == std::string::npos ? std::nan("") : leading_number(found.cause.substr(at + marker.size()));
  return fmt::format("Why: with {} joints come apart; the worst is the {}: {} (m at s).{} {}", names,
                     found.worst.component, text_over_steps(found),
                     grows ? fmt::format(" It grows with time: {:.2g} m within the first second.", found.beside)
                           : standing_gap(found, share),
                     found.cause);
}

std::string text_of_chain(const Diagnosis& found, const std::string& names, const std::string& other,
                          const Scene& scene) {
  constexpr double kUneven = 1.5;
  const double ratio = mass_ratio(scene);
  const bool is_uneven = ratio > kUneven;
  return fmt::format(
      "Why: sweeping from joint to joint, {} stretches {} joints in a row{}, by {:.2g} m at dt = {} s; {} leaves "
      "{:.2g} m. A sweep carries a load on by one joint{}. {}",
      names, joints_in_a_row(scene), is_uneven ? fmt::format(", of masses up to {:.3g} : 1", ratio) : "", found.value,
      found.over.front().first.text, other, found.beside,
      is_uneven ? ", and by little of it past a light body under a heavy one" : "", found.cause);
}

std::string text_of_energy(const Diagnosis& found, const std::string& names) {
  return fmt::format(
      "Why: with {} joints take energy that they should keep: {} of what is in play (at s), as the power {:.2g} of dt. "
      "A step turns velocities onto the joints as they stand at its beginning, and what lies across them is lost.",
      names, text_over_steps(found), found.beside);
}

// Of the finest step that says so, for there it is seen best; empty where none does.
std::string text_of_singular_positions(const Results& results, const CaseResult& result) {
  const Cell* finest = nullptr;
  std::string passed;
  for (const Cell& cell : result.cells) {
    for (const auto& [key, value] : cell.settings) {
      if (key != "singular positions" || (finest && finest->dt.seconds <= cell.dt.seconds)) continue;
      finest = &cell, passed = value;
    }
  }
  if (!finest) return "";
  return fmt::format(
      "Why: the joints pass a singular position, {} ({} at dt = {} s): rows of theirs come to repeat others there, and "
      "another motion branches off. Which one a run goes on by, and how it leaves, hangs on its own error there.",
      passed, results.runs[finest->run].text, finest->dt.text);
}

}  // namespace

std::vector<std::string> joint_explanations(const Results& results, const CaseResult& result) {
  const auto text_of = [&](const Diagnosis& found, const std::string& names) {
    if (found.topic == kJointsPart) return text_of_gap(found, names);
    if (found.topic == kJointsTakeEnergy) return text_of_energy(found, names);
    return text_of_chain(found, names, results.runs[found.runs[1]].text, result.definition.scene);
  };
  std::vector<std::pair<Diagnosis, std::string>> said;  // and of whom: the same is said of several at once
  for (const Diagnosis& found : joint_diagnoses(results, result)) {
    const std::string& name = results.runs[found.runs.front()].text;
    const auto same = std::find_if(said.begin(), said.end(),
                                   [&](const auto& one) { return text_of(one.first, "") == text_of(found, ""); });
    if (same == said.end()) {
      said.emplace_back(found, name);
    } else {
      same->second += ", " + name;
    }
  }
  std::vector<std::string> sentences;
  if (const std::string singular = text_of_singular_positions(results, result); !singular.empty())
    sentences.push_back(singular);
  for (const auto& [found, names] : said) sentences.push_back(text_of(found, names));
  return sentences;
}

}  // namespace rigor
