// The settings of the matched track, for the process of Siconos, its scheme replica and its calls.
#pragma once

namespace rigor::inline adapters {

inline constexpr double kSiconosTheta = 0.5, kSiconosTolerance = 1e-12;
// m: a contact whose predicted gap is no wider takes part in the step. Siconos ships 0, where a rounding of 1e-17 m
// lets a corner of a box at rest fall for a step.
inline constexpr double kSiconosTouching = 1e-10;
inline constexpr int kSiconosIterations = 1000;  // sweeps of the contact solver
// The most passes of Newton's method in a step.
inline constexpr int kSiconosPasses = 15, kSiconosPassesWithContacts = 5;

}  // namespace rigor::inline adapters
