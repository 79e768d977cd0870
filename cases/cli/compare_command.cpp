// rigor compare lists what changed between two results. rigor baseline prints the short form of one.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "adapters/engines.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/gates/regression.h"
#include "cases/results/changes.h"
#include "core/base/error.h"
#include "core/base/near_match.h"

namespace rigor {
namespace {

void check_engine(const std::string& name) {
  std::vector<std::string> known;
  for (const EngineInfo& engine : infos_of(engines())) known.push_back(engine.name);
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw InputError(fmt::format("--regression: there is no engine '{}'{}; there is: {}", name,
                                 did_you_mean(name, known), listed(known)));
}

}  // namespace

static int compare_command(const CommandLine& line, const EngineTable&) {
  if (line.words.size() != 2) {
    throw InputError(fmt::format(
        "rigor compare: takes two files, OLD and NEW (a results.json or a baseline), and found {}", line.words.size()));
  }
  const Baseline before = read_baseline(line.words[0]), after = read_baseline(line.words[1]);
  const Changes changes = changes_between(before, after, line.factor);
  print_table(text_of(changes, line.factor));
  return changes.is_worse() ? kGateFailed : kGood;
}

static int baseline_command(const CommandLine& line, const EngineTable&) {
  if (line.words.size() != 1) throw InputError("rigor baseline: takes one file, a results.json");
  if (!line.regression.empty()) {
    check_engine(line.regression);
    const RegressionText found = regression_text(line.words[0], line.regression);
    print(found.text);
    if (found.left_out > 0) say(fmt::format("{} cells have no value to record", found.left_out));
    return kGood;
  }
  print(baseline_text(read_baseline(line.words[0])));
  return kGood;
}

CommandRow compare_row() {
  return {"compare",
          "list what improved or got worse between two results; exit 1 if anything got worse",
          "FILE",
          "OLD and NEW, each a results.json or a baseline",
          {"--factor"},
          {{"rigor compare old/results.json out/results.json", "two runs"},
           {"rigor compare baseline.txt out/results.json --factor 1.5", "ignore errors that grow by less than half"}},
          compare_command};
}

CommandRow baseline_row() {
  return {"baseline",
          "print the short form of a result, one line a cell, to keep and compare with",
          "FILE",
          "a results.json",
          {"--regression"},
          {{"rigor baseline out/results.json > baseline.txt", "keep a result"},
           {"rigor baseline out/results.json --regression ode", "the values for adapters/ode/regression.jsonl"}},
          baseline_command};
}

}  // namespace rigor
