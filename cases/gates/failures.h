// The failures of `rigor gate`: one row for each reason against exit code 0, with the worst instant. The console, the
// job summary and the annotations show the same rows.
#pragma once

#include <string>
#include <vector>

#include "cases/results/results.h"

namespace rigor::inline gates {

struct Failure {
  std::string case_id, engine, dt;  // the last two empty where it is not about one run or step
  std::string what;                 // the metric, or the status of a cell: "crashed"
  std::string found, limit;         // "0.0612 m", "at most 0.06 m"
  std::string worst;                // "at 4.97 s: cube, position: found ..., expected ..."
  std::string because;              // the gate's, or why there is no value
  std::string where;                // "file:line:column" of the gate or deviation row; may be empty
};

std::vector<Failure> failures(const Results& results);

// Gates of families that no cell of any case met: of a whole suite there should be none.
std::vector<Gate> unmet_family_gates(const Results& grid);

}  // namespace rigor::inline gates
