#include "cases/import/assembly/joint_zeros.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "core/base/error.h"

namespace rigor::inline imports {
namespace {

// Returns the joints at each link, by link + 1.
std::vector<std::vector<int>> joints_of_links(const LinkModel& model) {
  std::vector<std::vector<int>> at(model.links.size() + 1);
  for (std::size_t k = 0; k < model.joints.size(); ++k) {
    at[model.joints[k].joint.a + 1].push_back(static_cast<int>(k));
    at[model.joints[k].joint.b + 1].push_back(static_cast<int>(k));
  }
  return at;
}

// Visits each link that joints connect with the world, with a static link or else with the root of its tree. Calls
// `see(joint, from, to)` after it has visited `from`.
void walk(const LinkModel& model, const std::function<void(int joint, int from, int to)>& see) {
  const auto at = joints_of_links(model);
  std::vector<bool> seen(model.links.size() + 1, false);
  std::vector<int> waiting;
  const auto walk_from = [&](int root) {
    if (seen[root + 1]) return;
    seen[root + 1] = true, waiting.push_back(root);
    while (!waiting.empty()) {
      const int from = waiting.back();
      waiting.pop_back();
      for (const int k : at[from + 1]) {
        const Joint& joint = model.joints[k].joint;
        const int to = joint.a == from ? joint.b : joint.a;
        if (seen[to + 1]) continue;
        seen[to + 1] = true, waiting.push_back(to);
        see(k, from, to);
      }
    }
  };
  const int count = static_cast<int>(model.links.size());
  std::vector<bool> hangs(model.links.size() + 1, false);
  for (const LinkJoint& row : model.joints) hangs[row.joint.b + 1] = true;
  walk_from(kWorld);
  for (int i = 0; i < count; ++i) {
    if (model.links[i].is_static) walk_from(i);
  }
  for (int i = 0; i < count; ++i) {
    if (!hangs[i + 1]) walk_from(i);
  }
  for (int i = 0; i < count; ++i) walk_from(i);
}

BodyPose turned_about(const Vec3& anchor, const Vec3& axis, double angle) {
  const Quat turn = rotation_by(angle * axis);
  return {anchor - turn * anchor, turn};
}

// The motion of the joint's b at its start, with all joints before it at zero.
BodyPose motion_at_start(const LinkJoint& row) {
  const Vec3* axis = free_axis(row.joint);
  if (!axis) return {};
  if (turns(row.joint)) return turned_about(*anchor_of(row.joint), *axis, row.start);
  return {row.start * *axis, Quat::Identity()};
}

void move(const BodyPose& by, Link& link) {
  link.pose = by * link.pose;
  for (LinkInertial& inertial : link.inertial) inertial.pose = by * inertial.pose;
  for (LinkShape& shape : link.shapes) shape.pose = by * shape.pose;
}

void move(const BodyPose& by, Joint& joint) {
  for_each_vector(joint.type, [&](const char*, JointVector kind, Vec3& vector) {
    if (kind == JointVector::point) vector = by.position + by.orientation * vector;
    if (kind == JointVector::direction) vector = (by.orientation * vector).normalized();
  });
}

void choose_start(LinkJoint& row, bool has_state, LeftOut& left_out) {
  const double within = std::clamp(row.start, row.joint.lower, row.joint.upper);
  if (within == row.start) return;
  const LossKind kind = has_state ? LossKind::physical : LossKind::assumed;
  left_out.add(row.where, "a start beyond the limits",
               {kind, fmt::format("the joint starts at the nearest limit, {:.3g} {} away", std::abs(within - row.start),
                                  turns(row.joint) ? "rad" : "m")});
  row.start = within;
}

// A joint that follows another one starts where that puts it. Chains of couplings need a pass for each.
void close_couplings(LinkModel& model) {
  bool changes = true;
  for (std::size_t pass = 0; changes && pass <= model.couplings.size(); ++pass) {
    changes = false;
    for (const LinkCoupling& row : model.couplings) {
      LinkJoint& joint = model.joints[row.joint];
      double start = row.offset;
      for (const JointTerm& term : row.to) start += term.ratio * model.joints[term.joint].start;
      if (start == joint.start) continue;
      if (pass == model.couplings.size())
        throw InputError(fmt::format("{}: its couplings contradict each other", row.where));
      if (start < joint.joint.lower || start > joint.joint.upper)
        throw InputError(fmt::format("{}: starts its joint at {:g}, beyond the limits {:g} and {:g}", row.where, start,
                                     joint.joint.lower, joint.joint.upper));
      joint.start = start, changes = true;
    }
  }
}

}  // namespace

void take_to_start(LinkModel& model) {
  for (LinkJoint& row : model.joints) choose_start(row, model.has_state, model.left_out);
  close_couplings(model);
  const bool at_zero =
      std::all_of(model.joints.begin(), model.joints.end(), [](const LinkJoint& row) { return row.start == 0; });
  if (at_zero) return;
  std::vector<BodyPose> by(model.links.size() + 1);
  std::vector<bool> is_taken(model.joints.size(), false);
  walk(model, [&](int k, int from, int to) {
    const LinkJoint& row = model.joints[k];
    const BodyPose motion = motion_at_start(row);
    by[to + 1] = by[from + 1] * (row.joint.b == to ? motion : inverse(motion));
    is_taken[k] = true;
  });
  for (std::size_t k = 0; k < model.joints.size(); ++k) {
    const Joint& joint = model.joints[k].joint;
    const BodyPose apart = inverse(by[joint.a + 1]) * by[joint.b + 1];
    constexpr double kRounding = 1e-12;  // of a few turns of lengths of some metres
    const bool is_moved = apart.position.norm() > kRounding || apart.orientation.vec().norm() > kRounding;
    if (!is_taken[k] && (model.joints[k].start != 0 || is_moved))
      throw InputError(fmt::format(
          "{}: closes a loop of joints that do not all start at their zeros; allowed: poses in which they do",
          model.joints[k].where));
  }
  for (std::size_t i = 0; i < model.links.size(); ++i) move(by[i + 1], model.links[i]);
  for (LinkJoint& row : model.joints) {
    move(by[row.joint.a + 1], row.joint);
    row.joint.lower -= row.start, row.joint.upper -= row.start, row.joint.rest -= row.start, row.start = 0;
  }
}

}  // namespace rigor::inline imports
