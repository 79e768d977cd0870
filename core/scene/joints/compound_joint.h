// Several joints with an axis each, in series from a to b. In Scene::joints a CompoundJoint stands for what they lock
// together. Directly behind it stands one row for each axis, a CompoundAxis with the same ends. So each axis has its
// own name, limits, spring, damper, armature and motors, as a hinge or slider has.
#pragma once

#include <cstddef>
#include <vector>

#include "core/scene/joints/joint_descriptor.h"

namespace rigor::inline scene {

// At most three hinges and three sliders: more axes repeat others, or turn about parallel lines.
inline constexpr std::size_t kMostSeriesAxes = 6;
inline constexpr int kMostSeriesAxesOfAKind = 3;

struct SeriesAxis {
  bool turns = true;           // a hinge; else a slider
  Vec3 anchor = Vec3::Zero();  // m, in W at t = 0; of a hinge
  Vec3 axis = Vec3::UnitZ();   // unit, in W at t = 0
};
inline bool operator==(const SeriesAxis& one, const SeriesAxis& other) {
  return one.turns == other.turns && one.anchor == other.anchor && one.axis == other.axis;
}

// Calls visitor(key, kind, vector) for the vectors of an axis.
template <typename Axis, typename Visitor>
void visit_series_axis(Axis& axis, const Visitor& visitor) {
  if (axis.turns) visitor("anchor", JointVector::point, axis.anchor);
  visitor("axis", JointVector::direction, axis.axis);
}

struct CompoundJoint {
  std::vector<SeriesAxis> axes;  // the first moves with a

  static constexpr JointDescriptor<CompoundJoint> descriptor() {
    JointDescriptor<CompoundJoint> row = {"compound", "Up to six hinges and sliders in series, from a to b."};
    row.has_own_vectors = true;
    return row;
  }
  template <typename Joint, typename Visitor>
  static void visit_vectors(Joint& joint, const Visitor& visitor) {
    for (auto& axis : joint.axes) visit_series_axis(axis, visitor);
  }
};

struct CompoundAxis {
  std::vector<SeriesAxis> axes;  // those of its compound joint
  std::size_t index = 0;         // which of them it is

  const SeriesAxis& own() const { return axes[index]; }
  static constexpr JointDescriptor<CompoundAxis> descriptor() {
    JointDescriptor<CompoundAxis> row = {"compound-axis", "One axis of a compound joint; it locks nothing by itself."};
    row.has_own_vectors = true;
    return row;
  }
  // Its own first.
  template <typename Joint, typename Visitor>
  static void visit_vectors(Joint& joint, const Visitor& visitor) {
    if (joint.index < joint.axes.size()) visit_series_axis(joint.axes[joint.index], visitor);
    for (std::size_t i = 0; i < joint.axes.size(); ++i)
      if (i != joint.index) visit_series_axis(joint.axes[i], visitor);
  }
};

}  // namespace rigor::inline scene
