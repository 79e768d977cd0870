// rigor compare and rigor baseline: what changed between two results, and the short form of one to keep.
#include <fmt/format.h>

#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/results/changes.h"
#include "core/base/error.h"

namespace rigor {

int compare_command(const CommandLine& line, const EngineTable&) {
  if (line.words.size() != 2) {
    throw InputError(
        fmt::format("rigor compare: takes two files, OLD and NEW, and found {}; each is a results.json or a "
                    "baseline",
                    line.words.size()));
  }
  const Outcomes before = read_outcomes(line.words[0]), after = read_outcomes(line.words[1]);
  const Changes changes = changes_between(before, after, line.factor);
  print_table(text_of(changes, line.factor));
  return changes.is_worse() ? kGateFailed : kGood;
}

int baseline_command(const CommandLine& line, const EngineTable&) {
  if (line.words.size() != 1) throw InputError("rigor baseline: takes one file, a results.json");
  print(baseline_text(read_outcomes(line.words[0])));
  return kGood;
}

}  // namespace rigor
