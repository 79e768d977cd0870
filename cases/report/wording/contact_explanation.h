// Why contacts come out wrong, in words: restitution that does not converge, overlap given back as speed, friction that
// knows directions. What was measured is said with it, and the engine's own setting that explains it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cases/results/results.h"

namespace rigor {

struct ContactFault {
  double size = 0;  // of a restitution: the largest error at a finer step; of an overlap: of the speed bodies met with
  std::string series;  // in words, over dt
  std::string reason;  // the engine's own setting; empty if it tells of none
};

// Bounces that are no better at a finer step.
std::optional<ContactFault> unconverged_restitution(const CaseResult& result, std::size_t run);

// An overlap given back as speed after an impact that should leave none.
std::optional<ContactFault> overlap_given_back(const CaseResult& result, std::size_t run);

std::vector<std::string> contact_explanations(const Results& results, const CaseResult& result);

}  // namespace rigor
