// rigor compare lists what changed between two results. rigor baseline prints the short form of one.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "adapters/engines.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/gates/regression.h"
#include "cases/results/changes.h"
#include "core/base/error.h"
#include "core/base/near_match.h"

namespace rigor::inline cli {
namespace {

void check_engine(const std::string& name) {
  std::vector<std::string> known;
  for (const EngineInfo& engine : infos_of(engines())) known.push_back(engine.name);
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw InputError(fmt::format("--regression: there is no engine '{}'{}; there is: {}", name,
                                 did_you_mean(name, known), listed(known)));
}

double parse_factor(const std::string& text) {
  double factor = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), factor);
  if (error != std::errc() || end != text.data() + text.size() || !(factor >= 1) || !std::isfinite(factor))
    throw InputError(fmt::format("--factor: '{}' is not a number of 1 or more", text));
  return factor;
}

class CompareCommand : public Command {
 public:
  void declare(Options& options) override {
    options.add_words(files_);
    options.add({"--factor", "F", fmt::format("ignore errors that grow by less; default: {:g}", kDefaultFactor)},
                [this](const std::string& text) { factor_ = parse_factor(text); });
  }

  int run(const Invocation&) override {
    if (files_.size() != 2) {
      throw InputError(fmt::format(
          "rigor compare: takes two files, OLD and NEW (a results.json or a baseline), and found {}", files_.size()));
    }
    const Baseline before = read_baseline(files_[0]), after = read_baseline(files_[1]);
    const Changes changes = changes_between(before, after, factor_);
    print_table(text_of(changes, factor_));
    return changes.is_worse() ? kGateFailed : kGood;
  }

 private:
  std::vector<std::string> files_;
  double factor_ = kDefaultFactor;  // by which an error has to grow to be worse
};

class BaselineCommand : public Command {
 public:
  void declare(Options& options) override {
    options.add_words(files_);
    options.add({"--regression", "ENGINE", "print the values of this engine for adapters/ENGINE/regression.jsonl"},
                engine_);
  }

  int run(const Invocation&) override {
    if (files_.size() != 1) throw InputError("rigor baseline: takes one file, a results.json");
    if (engine_.empty()) return print(baseline_text(read_baseline(files_[0]))), kGood;
    check_engine(engine_);
    const RegressionText found = regression_text(files_[0], engine_);
    print(found.text);
    if (found.left_out > 0) say(fmt::format("{} cells have no value to record", found.left_out));
    return kGood;
  }

 private:
  std::vector<std::string> files_;
  std::string engine_;  // whose recorded values are printed; empty: the baseline itself
};

}  // namespace

CommandRow compare_row() {
  return {"compare",
          "list what improved or got worse between two results; exit 1 if anything got worse",
          "FILE",
          "OLD and NEW, each a results.json or a baseline",
          {{"rigor compare old/results.json out/results.json", "two runs"},
           {"rigor compare baseline.txt out/results.json --factor 1.5", "ignore errors that grow by less than half"}},
          make_command<CompareCommand>};
}

CommandRow baseline_row() {
  return {"baseline",
          "print the short form of a result, one line a cell, to keep and compare with",
          "FILE",
          "a results.json",
          {{"rigor baseline out/results.json > baseline.txt", "keep a result"},
           {"rigor baseline out/results.json --regression ode", "the values for adapters/ode/regression.jsonl"}},
          make_command<BaselineCommand>};
}

}  // namespace rigor::inline cli
