// Reads MJCF by MuJoCo's own parser.
#pragma once

#include "adapters/common/compiled_mjcf.h"

namespace rigor::inline adapters {

// The caller has seen to it that the file names no other that may not be read. Throws InputError with MuJoCo's words.
CompiledMjcf read_with_mujoco(const MjcfSource& source);

}  // namespace rigor::inline adapters
