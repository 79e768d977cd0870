// What both the process that steps Siconos and its scheme replica take.
#pragma once

namespace rigor {

// The most passes of Newton's method in a step.
inline constexpr int kSiconosPasses = 15, kSiconosPassesWithContacts = 5;

}  // namespace rigor
