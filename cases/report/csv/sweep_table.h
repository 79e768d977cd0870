// The table of a sweep, a row a cell: as CSV, with units in its header, and as JSON lines of the same columns. The
// last, `held_to_itself`, names the metrics whose truth the run's own code makes: these are no witness of how right it
// is.
#pragma once

#include <string>

#include "cases/analysis/sweep/sweep.h"

namespace rigor::inline report {

std::string sweep_csv_header(const Sweep& sweep);
std::string sweep_csv_row(const Sweep& sweep, const SweepRow& row);
std::string sweep_json_row(const Sweep& sweep, const SweepRow& row);

// "dt [s]", "scene.spring[0].stiffness [N/m]"
std::string with_unit(const std::string& name, const std::string& unit);

}  // namespace rigor::inline report
