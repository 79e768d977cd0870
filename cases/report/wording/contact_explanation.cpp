#include "cases/report/wording/contact_explanation.h"

#include <fmt/format.h>

namespace rigor {
namespace {

std::string sentence_of(const Diagnosis& found, const std::string& name) {
  if (found.topic == kOverlapGivenBack) {
    return fmt::format(
        "Why: after an impact without bounce {} parts the bodies at {:.2g} of the speed they met with, "
        "at dt = {} s: an overlap is pushed out as speed.",
        name, found.value, found.over.front().first.text);
  }
  if (found.topic == kUnconverged) {
    return fmt::format("Why: the restitution of {} is off by {} s: it does not converge as dt falls.", name,
                       text_over_steps(found));
  }
  return fmt::format(
      "Why: with {} bodies that should all stop after the same way differ by {:.2g} of it, whatever dt "
      "is ({} s); the worst stops after {:.3g} m instead of {:.3g}. Its friction knows directions.",
      name, found.value, text_over_steps(found), found.worst.found, found.worst.expected);
}

}  // namespace

std::string text_over_steps(const Diagnosis& found) {
  std::string list;
  for (const auto& [dt, value] : found.over)
    list += fmt::format("{}{:.2g} at {}", list.empty() ? "" : ", ", value, dt.text);
  return list;
}

std::vector<std::string> contact_explanations(const Results& results, const CaseResult& result) {
  std::vector<std::string> sentences;
  for (const Diagnosis& found : contact_diagnoses(result)) {
    const std::string sentence = sentence_of(found, results.runs[found.runs.front()].text);
    sentences.push_back(found.cause.empty() ? sentence : sentence + " " + found.cause);
  }
  return sentences;
}

}  // namespace rigor
