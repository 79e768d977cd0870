#include "cases/report/wording/mistakes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace rigor::inline report {
namespace {

constexpr std::size_t kCasesShown = 6;

std::string counted(std::size_t count, const std::string& noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

// "a, b and 3 more".
std::string named_cases(const std::vector<std::string>& ids) {
  const std::size_t shown = ids.size() > kCasesShown ? kCasesShown - 1 : ids.size();
  const std::string text = fmt::format("{}", fmt::join(ids.begin(), ids.begin() + static_cast<long>(shown), ", "));
  return shown == ids.size() ? text : fmt::format("{} and {} more", text, ids.size() - shown);
}

// Laws whose drift no twin explains.
std::string laws_not_kept(const MistakeReport& report) {
  std::string text;
  for (const LawDrift& law : report.laws) {
    if (!law.is_kept && !law.has_twin) text += (text.empty() ? "" : " and ") + law.law;
  }
  return text;
}

std::string mistake_verdict(const MistakeReport& report) {
  using enum MistakeReport::Verdict;
  switch (report.verdict) {
    case right:
      return fmt::format("no error beyond what its scheme makes, in {}{}", counted(report.seen.size(), "case"),
                         laws_not_kept(report).empty() ? "" : ", unless its scheme keeps " + laws_not_kept(report));
    case named:
      return "looks like: " + fmt::format("{}", fmt::join(report.suspects.front().names, "; and "));
    case alike:
      return fmt::format("looks like one of {} mistakes, which move alike in these cases:", report.leaders);
    case unnamed:
      return fmt::format("looks like none of {} known mistakes; wrong in {} of {}: {}", report.known, report.off.size(),
                         counted(report.seen.size(), "case"), named_cases(report.off));
    case untried:
      return "none of its motions could be computed";
  }
  return "";
}

std::string suspect_line(const MistakeReport::Named& suspect) {
  return fmt::format("explains {} of the error, all of it in {} of {}: {}", share_in_words(suspect.explains),
                     suspect.explained, counted(suspect.cases.size(), "case"), fmt::join(suspect.names, "; and "));
}

std::string suspect_evidence(const MistakeReport::Named& suspect) {
  std::vector<CaseShare> cases = suspect.cases;
  std::stable_sort(cases.begin(), cases.end(), [](const auto& a, const auto& b) { return a.error > b.error; });
  std::string text;
  for (std::size_t n = 0; n < std::min(kCasesShown, cases.size()); ++n) {
    text += fmt::format("      {:<34}error {:.2g} of its motion; the mistake leaves {:.2g} of that\n", cases[n].id,
                        cases[n].error, cases[n].rest);
  }
  if (cases.size() > kCasesShown) text += fmt::format("      and {} more\n", cases.size() - kCasesShown);
  return text;
}

// The conservation laws that the motion was held to.
std::string laws_text(const MistakeReport& report) {
  std::string text;
  for (const LawDrift& law : report.laws) {
    if (law.is_kept) {
      text += fmt::format("  {}: kept to rounding in {}\n", law.law, counted(law.cases, "case"));
      continue;
    }
    text +=
        fmt::format("  {}: changes by {:.2g} of itself in {} at dt = {:g} s, by {:.2g} at half of it\n    {}\n",
                    law.law, law.drift, law.id, law.dt, law.at_half_dt,
                    law.has_twin ? "Its scheme replica (twin) has the same drift, unless a mistake is named above."
                                 : "Its scheme does this, or a mistake that vanishes with dt, such as stale-inertia.");
  }
  return text;
}

std::string blind_spot_text(const MistakeReport& report) {
  const std::size_t open = report.seen.size() - report.by_twin.size();
  if (open == 0) return "";
  return fmt::format(
      "  not visible in {} of {}: a mistake that vanishes with dt, such as late-friction-direction\n"
      "    Without a scheme replica (twin) of the engine it cannot be told from the error of the scheme.\n",
      open, counted(report.seen.size(), "case"));
}

}  // namespace

std::string share_in_words(double share) {
  if (share >= 1) return "100 %";
  const double percent = 100 * std::max(0.0, share), rest = 100 - percent;
  const int digits = rest >= 1 ? 0 : std::min(9, static_cast<int>(std::ceil(-std::log10(rest))));
  const double scale = std::pow(10.0, digits);
  return fmt::format("{:.{}f} %", std::floor(percent * scale) / scale, digits);
}

std::string text_of(const MistakeReport& report, const std::string& run) {
  std::string text = fmt::format("{}: {}\n", run, mistake_verdict(report));
  for (std::size_t n = 0; n < report.suspects.size(); ++n) {
    text += fmt::format("  {}. {}\n", n + 1, suspect_line(report.suspects[n]));
    if (n < std::max<std::size_t>(report.leaders, 1)) text += suspect_evidence(report.suspects[n]);
  }
  for (const std::string& failure : report.failures) text += fmt::format("  did not run {}\n", failure);
  text += laws_text(report) + blind_spot_text(report);
  if (!report.beside.empty()) text += fmt::format("  compared with {}\n", report.beside);
  return text;
}

}  // namespace rigor::inline report
