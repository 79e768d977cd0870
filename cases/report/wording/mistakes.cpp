#include "cases/report/wording/mistakes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace rigor {
namespace {

constexpr std::size_t kCasesShown = 6;

std::string counted(std::size_t count, const std::string& noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string mistake_verdict(const MistakeReport& report) {
  using enum MistakeReport::Verdict;
  switch (report.verdict) {
    case right:
      return fmt::format("no error beyond what its scheme makes, in {}", counted(report.seen.size(), "case"));
    case named:
      return "looks like: " + fmt::format("{}", fmt::join(report.suspects.front().names, "; and "));
    case alike:
      return fmt::format("looks like one of {} mistakes, which move alike in these cases:", report.leaders);
    case unnamed:
      return fmt::format("looks like none of {} known mistakes; off in {} of {}", report.known, report.off.size(),
                         counted(report.seen.size(), "case"));
    case untried:
      return "no motion of it is to be had";
  }
  return "";
}

std::string suspect_line(const MistakeReport::Named& suspect) {
  return fmt::format("explains {} of the error, whole in {} of {}: {}", share_in_words(suspect.explains),
                     suspect.explained, counted(suspect.cases.size(), "case"), fmt::join(suspect.names, "; and "));
}

std::string suspect_evidence(const MistakeReport::Named& suspect) {
  std::vector<CaseShare> cases = suspect.cases;
  std::stable_sort(cases.begin(), cases.end(), [](const auto& a, const auto& b) { return a.error > b.error; });
  std::string text;
  for (std::size_t n = 0; n < std::min(kCasesShown, cases.size()); ++n) {
    text += fmt::format("      {:<34}off by {:.2g} of its motion, beside the mistake {:.2g} of that is left\n",
                        cases[n].id, cases[n].error, cases[n].rest);
  }
  if (cases.size() > kCasesShown) text += fmt::format("      and {} more\n", cases.size() - kCasesShown);
  return text;
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
  for (const std::string& failure : report.failures) text += fmt::format("  not seen on {}\n", failure);
  if (!report.beside.empty()) text += fmt::format("  held against {}\n", report.beside);
  return text;
}

}  // namespace rigor
