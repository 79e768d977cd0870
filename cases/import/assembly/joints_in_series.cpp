#include "cases/import/assembly/joints_in_series.h"

#include <algorithm>
#include <cmath>

#include "core/scene/joints/axis_series.h"

namespace rigor::inline imports {
namespace {

bool is_bare(const LinkJoint& row) {
  const Joint& joint = row.joint;
  return joint.stiffness == 0 && joint.damping == 0 && !joint.has_limits() && row.friction == 0 && row.armature == 0 &&
         !row.is_driven;
}

bool is_universal(const std::vector<const LinkJoint*>& chain) {
  if (chain.size() != 2) return false;
  const auto *first = std::get_if<HingeJoint>(&chain[0]->joint.type),
             *second = std::get_if<HingeJoint>(&chain[1]->joint.type);
  constexpr double kSame = 1e-12, kRight = 1e-9;  // m, rad
  return first && second && is_bare(*chain[0]) && is_bare(*chain[1]) &&
         (first->anchor - second->anchor).norm() <= kSame && std::abs(first->axis.dot(second->axis)) <= kRight;
}

// The joint itself, and behind it one row for each axis.
void add_compound(const std::vector<const LinkJoint*>& chain, Joint whole, JointSeries& series) {
  std::vector<SeriesAxis> axes;
  for (const LinkJoint* row : chain) {
    const Vec3* anchor = anchor_of(row->joint);
    axes.push_back({turns(row->joint), anchor ? *anchor : Vec3::Zero().eval(), *free_axis(row->joint)});
  }
  if (!why_no_series(axes).empty()) return;
  whole.type = CompoundJoint{axes};
  whole.name.clear();
  series.rows.push_back(whole);
  for (std::size_t i = 0; i < chain.size(); ++i) {
    Joint part = chain[i]->joint;
    part.a = whole.a, part.b = whole.b, part.type = CompoundAxis{axes, i}, part.armature = chain[i]->armature;
    series.place[i] = static_cast<int>(series.rows.size());
    series.rows.push_back(part);
  }
}

}  // namespace

JointSeries joints_in_series(const std::vector<const LinkJoint*>& chain, int a, int b) {
  JointSeries series;
  series.place.assign(chain.size(), -1);
  Joint whole;
  whole.a = a, whole.b = b, whole.name = chain.front()->joint.name;
  if (is_universal(chain)) {
    const auto& first = std::get<HingeJoint>(chain[0]->joint.type);
    whole.type = UniversalJoint{first.anchor, first.axis, std::get<HingeJoint>(chain[1]->joint.type).axis};
    series.rows.push_back(whole);
    return series;
  }
  add_compound(chain, whole, series);
  return series;
}

}  // namespace rigor::inline imports
