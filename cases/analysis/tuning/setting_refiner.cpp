#include "cases/analysis/tuning/setting_refiner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rigor::inline analysis {

std::string RefinedNumber::at(double share) const {
  const double number = is_logarithmic ? low * std::pow(high / low, share) : low + share * (high - low);
  // Five digits are far finer than any bound can tell, and a name that a person can read.
  return whole ? fmt::format("{:.0f}", number) : fmt::format("{:.5g}", std::clamp(number, low, high));
}

double RefinedNumber::share_of(double number) const {
  return is_logarithmic ? std::log(number / low) / std::log(high / low) : (number - low) / (high - low);
}

std::vector<RefinedNumber> refined_numbers(const RunName& run, const std::vector<OptionInfo>& options) {
  std::vector<RefinedNumber> numbers;
  for (const OptionInfo& option : options) {
    const auto named = run.settings.options.find(option.name);
    if (named == run.settings.options.end() || !option.choices.empty()) continue;
    const double number = std::stod(named->second);
    RefinedNumber found{option.name, option.min, option.max, false, option.whole};
    for (const std::string& text : tried_values(option)) {
      const double tried = std::stod(text);
      if (tried < number) found.low = std::max(found.low, tried);
      if (tried > number) found.high = std::min(found.high, tried);
    }
    found.is_logarithmic = found.low > 0 && found.high > 2 * found.low;
    if (found.low < found.high) numbers.push_back(found);
  }
  return numbers;
}

namespace {

class Refiner {
 public:
  Refiner(const Refined& start, const std::vector<OptionInfo>& options, Prober& prober, const EngineTable& engines,
          int jobs)
      : best_(start), options_(options), prober_(prober), engines_(engines), jobs_(jobs) {}

  Refined best() {
    constexpr int kMostOptions = 2;  // named beside those of the start
    search_numbers();
    for (int i = 0; i < kMostOptions && best_.answer.error > 1 && name_one_more(); ++i) search_numbers();
    return best_;
  }

 private:
  bool improve(const Probe& probe, const ProbeAnswer& answer) {
    if (!(answer.error < best_.answer.error)) return false;
    best_ = {probe, answer};
    return true;
  }
  RunName run() const { return parse_run_name(best_.probe.run, engines_.infos()); }

  void search_numbers() {
    const RunName start = run();
    const std::vector<RefinedNumber> numbers = refined_numbers(start, options_);
    if (numbers.empty()) return;
    const auto error_at = [&, probe = best_.probe](const BoxPoint& point) mutable {
      for (std::size_t i = 0; i < numbers.size(); ++i)
        probe.run = with_option(probe.run, numbers[i].option, numbers[i].at(point[i]));
      const ProbeAnswer answer = prober_.run({probe}, {.is_timed = true}).front();
      improve(probe, answer);
      return answer.error;
    };
    BoxMinimum from{{}, best_.answer.error};
    for (const RefinedNumber& number : numbers)
      from.at.push_back(number.share_of(std::stod(start.settings.options.at(number.option))));
    constexpr double kEnough = 0.5;  // of the bound: a step beside this one may then keep it, too
    nelder_mead(error_at, from, {.size = 0.2, .tolerance = 1e-3, .most = 20 * numbers.size(), .enough = kEnough});
  }

  // Whether one more option, at one of its tried values, improves the run.
  bool name_one_more() {
    const RunName named = run();
    std::vector<Probe> probes;
    for (const OptionInfo& option : options_) {
      if (named.settings.options.contains(option.name)) continue;
      for (const std::string& value : tried_values(option))
        probes.push_back({with_option(best_.probe.run, option.name, value), best_.probe.step});
    }
    const auto answers = prober_.run(probes, {.is_timed = true, .jobs = jobs_});
    bool is_better = false;
    for (std::size_t i = 0; i < probes.size(); ++i) is_better |= improve(probes[i], answers[i]);
    return is_better;
  }

  Refined best_;
  const std::vector<OptionInfo>& options_;
  Prober& prober_;
  const EngineTable& engines_;
  int jobs_;
};

}  // namespace

Refined refine(const Refined& start, const std::vector<OptionInfo>& options, Prober& prober, const EngineTable& engines,
               int jobs) {
  return Refiner(start, options, prober, engines, jobs).best();
}

}  // namespace rigor::inline analysis
