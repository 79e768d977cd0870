// Claims about one cell, with its place filled in.
#pragma once

#include "cases/report/wording/message.h"
#include "cases/results/results.h"

namespace rigor::inline report {

inline Claim claim_of_cell(const Results& results, const CaseResult& result, const Cell& cell,
                           const std::string& quantity, double value) {
  return {quantity, result.definition.id, results.runs[cell.run].text, cell.dt.text, "", value};
}

inline Claim claim_of_scene(const CaseResult& result, const std::string& quantity, double value,
                            const std::string& part = "") {
  return {quantity, result.definition.id, "", "", part, value};
}

}  // namespace rigor::inline report
