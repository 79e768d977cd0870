// What a run did in a family of cases at the headline's step: what the matrix, the badges and the JSON of the site say.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cases/results/results.h"

namespace rigor::inline report {

// A case counts where it has this step, an error in m or rad against a truth that is independent of the run, and where
// the engine supports it. A cell without a result, or with a motion that is wrong as a whole, counts as not within.
struct Score {
  std::size_t compared = 0;
  std::size_t within = 0;       // of these, cells whose error is at most the tolerance
  std::size_t failed = 0;       // of these, cells without a result, or wrong as a whole
  std::size_t unsupported = 0;  // cells that the engine cannot do
  std::string unit = "m";       // "rad" if all errors are angles, "m or rad" for both kinds
  double median = 0;            // in that unit; of an even count the larger of the two; infinite if that one failed
  // s: the smallest over the cases of the largest stable step. A bound is one that was not left in the search.
  std::optional<StableStep> stable = {};
  std::size_t searched = 0;  // cases in which it was found
};

inline constexpr double kSiteTolerance = 1e-3;  // m or rad: as the report's matrix shows at first

// Of the cases of a family, or of all if it is empty.
Score score_of(const Results& results, std::size_t run, const std::string& family, const StepSize& headline);

// From 0 (a hundredth of the tolerance or less) to 5 (more than a hundred times it): the report's scale of colours.
// Level 2 is still within. None where nothing is compared or the median failed.
std::optional<int> level_of(const Score& score);

std::string family_of(const std::string& case_id);  // "" for a case without a folder
std::vector<std::string> families_of(const Results& results);
bool is_stock(const RunName& run);

// The runs of an engine in the order of the results; engines of others first, then ours.
struct EngineRuns {
  std::string engine;
  bool is_in_house = false;
  std::vector<std::size_t> runs;
};
std::vector<EngineRuns> engines_of(const Results& results);

// The run that an engine's badge is about: the one of the engine's plain name, else its first.
std::size_t main_run(const Results& results, const EngineRuns& engine);

}  // namespace rigor::inline report
