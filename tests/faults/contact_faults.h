// The part of the table of faults (faults.h) that is about contact.
#pragma once

#include <vector>

#include "tests/faults/broken_engine.h"

namespace rigor::test {

std::vector<Fault> contact_faults();

}  // namespace rigor::test
