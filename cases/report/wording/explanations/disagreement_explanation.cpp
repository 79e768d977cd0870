#include "cases/report/wording/explanations/disagreement_explanation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "adapters/engines.h"
#include "cases/report/wording/cell_claim.h"

namespace rigor::inline report {
namespace {

constexpr double kFarther = 10;      // than the median of the nearest distances
constexpr double kBeyondOthers = 3;  // times the largest distance of the others
constexpr double kOwnStep = 0.1;     // of the distance between engines: what the step still changes

class Disagreement {
 public:
  Disagreement(const Results& results, const CaseResult& result) : results_(results), result_(result) {
    const Spread* finest = nullptr;
    for (const Spread& spread : result.spreads) {
      if (!spread.is_own_step() && ran(spread) && (!finest || spread.dt.seconds < finest->dt.seconds)) finest = &spread;
    }
    if (!finest) return;
    dt_ = finest->dt;
    std::set<std::string> engines;
    for (std::size_t run = 0; run < results.runs.size(); ++run) {
      const bool is_compared = std::any_of(result.spreads.begin(), result.spreads.end(), [&](const Spread& spread) {
        return spread.dt == dt_ && !spread.is_own_step() && ran(spread) &&
               (spread.first == run || spread.second == run);
      });
      if (is_compared && engines.insert(results.runs[run].engine).second) runs_.push_back(run);
    }
  }

  std::vector<Message> messages() const {
    if (runs_.size() < 2) return {};
    const std::vector<std::size_t> apart = those_apart();
    std::vector<std::size_t> others;
    for (const std::size_t run : runs_) {
      if (std::find(apart.begin(), apart.end(), run) == apart.end()) others.push_back(run);
    }
    Claims claims;
    std::string text;
    for (const std::size_t run : apart) {
      const Spread& nearest = nearest_of(run);
      text +=
          fmt::format(" At dt = {} s {} stands apart: it is {} from the nearest other, {}{}.", dt_.text, name(run),
                      claims.quantity(nearest_claim(run, nearest), "m"), name(other_of(nearest, run)), where(nearest));
    }
    const Spread& widest = widest_of(others);
    const std::string distance = claims.quantity(claim_of(widest), "m");
    if (widest.distance.value == 0) return {{"disagreement", same_places(claims), "", claims.take()}};
    if (apart.empty())
      text +=
          fmt::format(" At dt = {} s {} engines are up to {} apart: most {} and {}{}.", dt_.text,
                      claims.count(count_claim()), distance, name(widest.first), name(widest.second), where(widest));
    else
      text += fmt::format(" The others are within {} of each other: {}.", distance, names(others));
    text += own_steps(widest, claims);
    return {{"disagreement", "No truth says who is right." + text, "", claims.take()}};
  }

 private:
  // A run that blew up is told elsewhere.
  bool ran(const Spread& spread) const {
    const auto stays = [&](std::size_t run) {
      return std::any_of(result_.cells.begin(), result_.cells.end(), [&](const Cell& cell) {
        return cell.run == run && cell.dt == spread.dt && !cell.metrics.empty() &&
               cell.stability.verdict != Verdict::blown_up;
      });
    };
    return stays(spread.first) && stays(spread.second);
  }

  std::string same_places(Claims& claims) const {
    return fmt::format("No truth says who is right. At dt = {} s {} engines keep every body at the same places.",
                       dt_.text, claims.count(count_claim()));
  }

  // Whether the run has nothing at finer steps, at which it may have blown up.
  bool ends_at_the_finest(std::size_t run) const {
    return std::none_of(result_.cells.begin(), result_.cells.end(), [&](const Cell& cell) {
      return cell.run == run && cell.status != Status::unsupported && cell.dt.seconds < dt_.seconds && cell.dt != dt_;
    });
  }

  // How much each run changes from the step before the finest to the finest: what a smaller step can still change.
  std::string own_steps(const Spread& widest, Claims& claims) const {
    std::vector<const Spread*> own;
    for (const std::size_t run : runs_) {
      const Spread* last = nullptr;
      for (const Spread& spread : result_.spreads) {
        const bool is_own = spread.is_own_step() && spread.first == run && ran(spread);
        if (is_own && (!last || spread.dt.seconds < last->dt.seconds)) last = &spread;
      }
      if (last && ends_at_the_finest(run)) own.push_back(last);
    }
    if (own.empty()) return "";
    const Spread& latest = **std::min_element(
        own.begin(), own.end(), [](const Spread* a, const Spread* b) { return a->dt.seconds < b->dt.seconds; });
    std::erase_if(own, [&](const Spread* one) { return !(one->dt == latest.dt); });
    double largest = 0;
    std::string said;
    for (const Spread* one : own) {
      largest = std::max(largest, one->distance.value);
      const Claim change = {"change to the finest step", result_.definition.id, name(one->first), one->dt.text, "",
                            one->distance.value};
      said += fmt::format("{}{} {}", said.empty() ? "" : ", ", name(one->first), claims.quantity(change, "m"));
    }
    // Of first order, what is left below the finest step. Two steps that are close together change little and leave
    // much.
    const double left = largest * dt_.seconds / (latest.dt.seconds - dt_.seconds);
    const bool is_of_models = own.size() == runs_.size() && std::max(largest, left) < kOwnStep * widest.distance.value;
    return fmt::format(" From dt = {} s to that step, positions still change: {}.{}", own.front()->dt.text, said,
                       is_of_models ? " A smaller step will not bring the engines together." : "");
  }

  static std::size_t other_of(const Spread& spread, std::size_t run) {
    return spread.first == run ? spread.second : spread.first;
  }

  // The spreads at dt_ among these runs.
  std::vector<const Spread*> among(const std::vector<std::size_t>& runs) const {
    const auto has = [&](std::size_t run) { return std::find(runs.begin(), runs.end(), run) != runs.end(); };
    std::vector<const Spread*> found;
    for (const Spread& spread : result_.spreads) {
      if (spread.dt == dt_ && has(spread.first) && has(spread.second)) found.push_back(&spread);
    }
    return found;
  }

  const Spread& nearest_of(std::size_t run) const {
    const Spread* nearest = nullptr;
    for (const Spread* spread : among(runs_)) {
      if (spread->first != run && spread->second != run) continue;
      if (voice_of(other_of(*spread, run)) == voice_of(run)) continue;
      if (!nearest || spread->distance.value < nearest->distance.value) nearest = spread;
    }
    return *nearest;
  }

  const Spread& widest_of(const std::vector<std::size_t>& runs) const {
    const auto pairs = among(runs);
    return **std::max_element(pairs.begin(), pairs.end(),
                              [](const Spread* a, const Spread* b) { return a->distance.value < b->distance.value; });
  }

  // Engines with the same formulas are one voice.
  std::string voice_of(std::size_t run) const { return formulas_of(results_.runs[run].engine); }
  std::vector<std::size_t> one_of_each_voice() const {
    std::vector<std::size_t> voices;
    std::set<std::string> heard;
    for (const std::size_t run : runs_)
      if (heard.insert(voice_of(run)).second) voices.push_back(run);
    return voices;
  }

  // Engines that are far from all others, but at least two voices are left to stand apart from.
  std::vector<std::size_t> those_apart() const {
    const std::vector<std::size_t> voices = one_of_each_voice();
    if (voices.size() < 3) return {};
    std::vector<double> nearest;
    for (const std::size_t run : voices) nearest.push_back(nearest_of(run).distance.value);
    std::vector<double> sorted = nearest;
    std::sort(sorted.begin(), sorted.end());
    const double median = sorted[sorted.size() / 2];
    std::vector<std::size_t> apart, others;
    for (std::size_t k = 0; k < voices.size(); ++k)
      (nearest[k] > kFarther * median ? apart : others).push_back(voices[k]);
    if (others.size() < 2) return {};
    const double spread = widest_of(others).distance.value;
    std::erase_if(apart, [&](std::size_t run) { return !(nearest_of(run).distance.value > kBeyondOthers * spread); });
    // Those that share a voice with them stand apart, too.
    std::vector<std::size_t> all;
    for (const std::size_t run : runs_) {
      const auto shares = [&](std::size_t one) { return voice_of(one) == voice_of(run); };
      if (std::any_of(apart.begin(), apart.end(), shares)) all.push_back(run);
    }
    return all;
  }

  const std::string& name(std::size_t run) const { return results_.runs[run].text; }
  std::string names(const std::vector<std::size_t>& runs) const {
    std::vector<std::string> all;
    for (const std::size_t run : runs) all.push_back(name(run));
    return fmt::format("{}", fmt::join(all, ", "));
  }
  std::string where(const Spread& spread) const {
    const std::string body = result_.definition.scene.body_name(spread.distance.body);
    return fmt::format(" ('{}', after {:.3g} s)", body, spread.distance.time);
  }

  Claim claim_of(const Spread& spread) const {
    return {"distance between runs", result_.definition.id, name(spread.first), dt_.text,
            name(spread.second),     spread.distance.value};
  }
  Claim nearest_claim(std::size_t run, const Spread& spread) const {
    return {"distance of the nearest", result_.definition.id, name(run), dt_.text, "", spread.distance.value};
  }
  Claim count_claim() const {
    return {"engines compared", result_.definition.id, "", dt_.text, "", static_cast<double>(runs_.size())};
  }

  const Results& results_;
  const CaseResult& result_;
  StepSize dt_{0, ""};
  std::vector<std::size_t> runs_;  // the first of each engine
};

}  // namespace

std::vector<Message> disagreement_explanations(const Results& results, const CaseResult& result) {
  const bool has_truth = result.truth && result.definition.truth != "none";
  if (has_truth || result.definition.ensemble > 0) return {};
  return Disagreement(results, result).messages();
}

}  // namespace rigor::inline report
