// Error against cost over many cases, and the engine and step that it recommends, as parts of results.json.
#pragma once

#include "cases/results/results.h"
#include "core/base/json_fwd.h"

namespace rigor::inline report {

// An array: all cases (`family` is empty), and each family if there are several.
Json frontier_json(const Results& results);

// For 1 mm: the cheapest step of an external engine, of a method of the core, and of an adaptive reference; null where
// none is within it.
Json recommendation_json(const Results& results);

}  // namespace rigor::inline report
