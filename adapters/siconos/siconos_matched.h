// What both the process that steps Siconos and its scheme replica take.
#pragma once

namespace rigor {

// Passes of Newton's method in each step of a scene without contacts, whatever their residual. Siconos looks at the
// residual of momentum alone and stops when that is small, which a free body's is long before its position is at rest.
inline constexpr int kSiconosPasses = 15;

}  // namespace rigor
