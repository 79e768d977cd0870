// What a shape may touch with at one point of its boundary, in B. Which of these it is depends on the other shape.
#pragma once

#include "core/dynamics/contact/event/features/contact_features.h"

namespace rigor::inline dynamics {

struct Choices {
  std::optional<ContactFeature> plane, line;
  ContactFeature point;
};

inline constexpr double kOnEdge = 1e-7;    // of a body's size: how near an edge a point counts as on it
inline constexpr double kAligned = 1e-12;  // 1 - the cosine between a normal and a side's: 1.4e-6 rad

}  // namespace rigor::inline dynamics
