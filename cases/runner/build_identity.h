// Identifies this build: one build does not continue the results of another.
#pragma once

#include <string>

namespace rigor::inline runner {

// A hash of the bytes of the program and of every linked shared library, engines included. Computed once.
const std::string& build_identity();

}  // namespace rigor::inline runner
