// The cells that findings read: those of a run at the headline step that have metrics.
#pragma once

#include "cases/report/wording/cell_claim.h"
#include "cases/results/results.h"

namespace rigor::inline report {

template <typename F>
void for_headline_cells(const Results& results, std::size_t run, const StepSize& dt, const F& f) {
  for (const CaseResult& result : results.cases) {
    for (const Cell& cell : result.cells) {
      if (cell.run == run && cell.dt == dt && !cell.metrics.empty()) f(result, cell);
    }
  }
}

}  // namespace rigor::inline report
