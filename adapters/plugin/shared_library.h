// A shared library that speaks rigor_engine.h.
#pragma once

#include <string>

#include "adapters/plugin/rigor_engine.h"

namespace rigor::inline adapters {

// Loads it permanently into this process. Throws InputError with a sentence about the error. A library may do anything,
// so call this in a process that may be lost.
const rigor_engine_v1& load_library(const std::string& path);

// The text of its info, asked in a child process: one that crashes, exits or hangs is an InputError.
std::string info_of_library(const std::string& path, double limit);

inline constexpr std::size_t kRoomForText = 1 << 16;  // bytes, of each call

}  // namespace rigor::inline adapters
