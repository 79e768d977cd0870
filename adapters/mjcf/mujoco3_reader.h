// MJCF as the MuJoCo of today reads it: its package of the npm registry, run by Node in a process of its own.
#pragma once

#include <optional>

#include "adapters/common/compiled_mjcf.h"

namespace rigor::inline adapters {

// The folder whose node_modules has @mujoco/mujoco: RIGOR_MUJOCO3. Empty if it is not set or has no such package.
std::string mujoco3_folder();

// Throws InputError with MuJoCo's words where it refuses the model, and std::runtime_error where it cannot be run.
CompiledMjcf read_with_mujoco3(const MjcfSource& source);

}  // namespace rigor::inline adapters
