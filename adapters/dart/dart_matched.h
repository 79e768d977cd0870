// The settings of DART's matched track. The reasons are in adapters/dart/README.md.
#pragma once

#include <cstddef>

namespace rigor::inline adapters {

// Shares closed in a step, where DART ships with a hundredth, and of an overlap with at most 1 mm/s.
inline constexpr double kDartContactErp = 0.2, kDartLoopErp = 0.8, kDartContactSpeed = 1e3;  // m/s
inline constexpr double kDartCfm = 1e-9;                   // the least that DART takes; as shipped 1e-5
inline constexpr std::size_t kDartMostContacts = 1000000;  // a step; as shipped 1000, and the rest is left out

}  // namespace rigor::inline adapters
