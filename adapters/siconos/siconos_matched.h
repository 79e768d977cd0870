// The settings of the matched track, for the process of Siconos, its scheme replica and its calls.
#pragma once

namespace rigor {

inline constexpr double kSiconosTheta = 0.5, kSiconosTolerance = 1e-12;
inline constexpr int kSiconosIterations = 1000;  // sweeps of the contact solver
// The most passes of Newton's method in a step.
inline constexpr int kSiconosPasses = 15, kSiconosPassesWithContacts = 5;

}  // namespace rigor
