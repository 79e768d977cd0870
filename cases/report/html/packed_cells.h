// Cells in the form in which the page holds them: most of a long results.json is the names of keys and equal texts. A
// browser opens the page faster with fewer characters.
#pragma once

#include "core/base/json_fwd.h"

namespace rigor::inline report {

// The metrics of a cell become an array of arrays: name, value, then of the worst instant time [s], body, component
// and, where they are not the value and 0, found and expected; last an object of whatever else there is. Names, bodies
// and components are indices of `strings`, settings are indices of `cell_settings`; both are new keys of the results.
// data.js reads them back.
void pack_cells(Json& results);

}  // namespace rigor::inline report
