// What `rigor repeat --json` prints of a case.
#pragma once

#include "cases/analysis/repeats/repeats.h"
#include "core/base/json_fwd.h"

namespace rigor::inline report {

Json repeats_json(const RepeatReport& report);

}  // namespace rigor::inline report
