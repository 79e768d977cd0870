#include "cases/report/wording/recommendation.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "cases/analysis/frontier.h"
#include "cases/report/wording/findings/recorded_finding.h"

namespace rigor::inline report {
namespace {

class Recommending {
 public:
  explicit Recommending(const Results& results) : results_(results), all_(frontiers(results)) {}

  std::optional<Message> message() {
    if (all_.empty()) return recorded_finding(results_);
    if (nothing_moves(results_)) return Message{"recommendation", nothing_moves_text(results_)};
    const auto engine = within(Candidates::engines);
    const auto method = within(Candidates::core_methods), reference = within(Candidates::references);
    Message message{"recommendation", ""};
    if (engine)
      message.text = fmt::format("For 1 mm take {}{}.", name_of(*engine), counted(*engine));
    else
      message.text = has_engines() ? "No engine stays within 1 mm at the steps tried." : "";
    if (method) message.more += fmt::format(" Rigor's core: {}{}.", name_of(*method), counted(*method));
    if (reference) message.more += fmt::format(" Adaptive reference: {}.", name_of(*reference));
    if (message.text.empty() && !message.more.empty()) message.text = "For 1 mm:" + message.more, message.more = "";
    if (message.text.empty()) message.text = "Nothing stays within 1 mm at the steps tried.";
    if (message.more.starts_with(" ")) message.more.erase(0, 1);
    message.claims = claims_.take();
    return message;
  }

 private:
  bool has_engines() const {
    for (const Frontier& frontier : all_)
      if (!is_in_house(results_, frontier.run)) return true;
    return false;
  }

  std::optional<Choice> within(Candidates candidates) const {
    return cheapest_within(results_, all_, kRecommendedTolerance, candidates);
  }

  std::string name_of(const Choice& choice) {
    const std::string& run = results_.runs[choice.run].text;
    claims_.state({"geometric mean of main errors", "", run, choice.point.dt.text, "", choice.point.mean,
                   Relation::at_most, kRecommendedTolerance});
    return fmt::format("{} at {} s", run, choice.point.dt.text);
  }

  // " (65 of 117 cases compared, 1 failed, 42 unsupported)"; nothing for a single case.
  std::string counted(const Choice& choice) {
    if (results_.cases.size() < 2) return "";
    const std::string& run = results_.runs[choice.run].text;
    const auto count = [&](const char* quantity, std::size_t value) {
      return claims_.count({quantity, "", run, choice.point.dt.text, "", static_cast<double>(value)});
    };
    const std::string unsupported =
        choice.unsupported == 0 ? "" : fmt::format(", {} unsupported", count("cases unsupported", choice.unsupported));
    return fmt::format(" ({} of {} cases compared, {} failed{})", count("cases compared", choice.point.cases),
                       results_.cases.size(),
                       choice.point.failed == 0 ? "none" : count("cases failed", choice.point.failed), unsupported);
  }

  const Results& results_;
  std::vector<Frontier> all_;
  Claims claims_;
};

}  // namespace

std::optional<Message> recommendation(const Results& results) { return Recommending(results).message(); }

bool nothing_moves(const Results& results) {
  const auto is_still = [](const CaseResult& result) { return result.truth && result.truth->is_still; };
  return !results.cases.empty() && std::all_of(results.cases.begin(), results.cases.end(), is_still);
}

std::string nothing_moves_text(const Results& results) {
  return results.cases.size() == 1 ? "Nothing moves in this case, so it tells no step size."
                                   : "Nothing moves in these cases, so they tell no step size.";
}

}  // namespace rigor::inline report
