// The table of faults: each breaks one thing that engines and their adapters have been seen to get wrong.
#pragma once

#include <vector>

#include "tests/faults/broken_engine.h"

namespace rigor::test {

const std::vector<Fault>& faults();

}  // namespace rigor::test
