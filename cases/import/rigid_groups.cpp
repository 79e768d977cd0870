#include "cases/import/rigid_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "core/base/error.h"

namespace rigor {
namespace {

// Sets of links. A set is named by its least member, so that the world keeps set 0.
class Sets {
 public:
  explicit Sets(std::size_t links) : of_(links + 1) { std::iota(of_.begin(), of_.end(), 0); }
  int find(int link) {
    int i = link + 1;
    while (of_[i] != i) i = of_[i] = of_[of_[i]];
    return i;
  }
  void join(int a, int b) {
    const int first = find(a), second = find(b);
    of_[std::max(first, second)] = std::min(first, second);
  }

 private:
  std::vector<int> of_;
};

bool is_fixed(const LinkJoint& row) { return std::holds_alternative<FixedJoint>(row.joint.type); }

// Returns the joints at each link, by link + 1.
std::vector<std::vector<int>> joints_at(const LinkModel& model) {
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
  const auto at = joints_at(model);
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

// Marks links that fixed joints hold to the world as static.
void hold_by_world(LinkModel& model) {
  const auto at = joints_at(model);
  std::vector<int> waiting = {kWorld};
  for (int i = 0; i < static_cast<int>(model.links.size()); ++i) {
    if (model.links[i].is_static) waiting.push_back(i);
  }
  while (!waiting.empty()) {
    const int link = waiting.back();
    waiting.pop_back();
    for (const int k : at[link + 1]) {
      const Joint& joint = model.joints[k].joint;
      const int other = joint.a == link ? joint.b : joint.a;
      if (!is_fixed(model.joints[k]) || other == kWorld || model.links[other].is_static) continue;
      model.links[other].is_static = true, waiting.push_back(other);
    }
  }
}

// A set of links without mass is left out at the end of a tree, and refused between moving links.
void settle_massless(LinkModel& model, RigidGroups& groups) {
  const auto massless = [&](int link) {
    return groups.body[link] != kWorld && groups.body[link] != RigidGroups::kNone &&
           model.links[groups.body[link]].inertial.empty();
  };
  const auto body_of = [&](int link) { return link == kWorld ? kWorld : groups.body[link]; };
  const auto at = joints_at(model);
  std::vector<std::vector<int>> members(model.links.size());
  for (int i = 0; i < static_cast<int>(model.links.size()); ++i) {
    if (groups.body[i] >= 0) members[groups.body[i]].push_back(i);
  }
  std::vector<int> waiting;
  for (int i = 0; i < static_cast<int>(model.links.size()); ++i) {
    if (massless(i) && groups.body[i] == i) waiting.push_back(i);
  }
  std::vector<bool> is_gone(model.joints.size(), false);
  while (!waiting.empty()) {  // a set at the end of a tree goes with its joint, which may leave another one at the end
    const int set = waiting.back();
    waiting.pop_back();
    if (groups.body[set] == RigidGroups::kNone) continue;
    std::vector<int> moving;
    for (const int link : members[set]) {
      for (const int k : at[link + 1]) {
        const Joint& joint = model.joints[k].joint;
        if (!is_gone[k] && body_of(joint.a) != body_of(joint.b)) moving.push_back(k);
      }
    }
    if (moving.size() > 1) continue;
    for (const int link : members[set]) {
      model.left_out.add(model.links[link].where, "the link", "changes no motion: it has no mass and carries none");
      groups.body[link] = RigidGroups::kNone;
    }
    for (const int k : moving) {
      is_gone[k] = true;
      model.left_out.add(model.joints[k].where, "the joint", "changes no motion: what it carries has no mass");
      const Joint& joint = model.joints[k].joint;
      for (const int end : {joint.a, joint.b}) {
        if (end != kWorld && groups.body[end] >= 0 && massless(end)) waiting.push_back(groups.body[end]);
      }
    }
  }
  for (int i = 0; i < static_cast<int>(model.links.size()); ++i) {
    if (massless(i))
      throw InputError(fmt::format(
          "{}: there is no <inertial>, and it moves between other links: nothing without mass can be simulated; "
          "allowed: a mass, or fixed joints",
          model.links[i].where));
  }
  std::vector<LinkJoint> left;
  std::vector<int> place(model.joints.size(), -1);
  for (std::size_t k = 0; k < model.joints.size(); ++k) {
    if (!is_gone[k]) place[k] = static_cast<int>(left.size()), left.push_back(model.joints[k]);
  }
  model.joints = std::move(left);
  std::erase_if(model.motors, [&](const Motor& motor) { return place[motor.joint] < 0; });
  for (Motor& motor : model.motors) motor.joint = place[motor.joint];
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

void choose_start(LinkJoint& row, LeftOut& left_out) {
  const double within = std::clamp(row.start, row.joint.lower, row.joint.upper);
  if (within == row.start) return;
  left_out.add(row.where, fmt::format("its position {:g}", row.start),
               fmt::format("is beyond its limits: it starts at {:g}", within));
  row.start = within;
}

}  // namespace

RigidGroups rigid_groups(LinkModel& model) {
  hold_by_world(model);
  const std::size_t count = model.links.size();
  Sets sets(count);
  const auto massless = [&](int link) {
    return link != kWorld && !model.links[link].is_static && model.links[link].inertial.empty();
  };
  for (const LinkJoint& row : model.joints) {
    if (is_fixed(row) && massless(row.joint.a) && massless(row.joint.b)) sets.join(row.joint.a, row.joint.b);
  }
  std::vector<int> body(count + 1, RigidGroups::kNone);  // by set: the link with mass
  for (const LinkJoint& row : model.joints) {
    for (const auto& [frame, carrier] : {std::pair{row.joint.a, row.joint.b}, {row.joint.b, row.joint.a}}) {
      if (!is_fixed(row) || !massless(frame) || massless(carrier) || carrier == kWorld) continue;
      int& of = body[sets.find(frame)];
      if (of == RigidGroups::kNone) of = carrier;
    }
  }
  RigidGroups groups;
  for (int i = 0; i < static_cast<int>(count); ++i) {
    const int of = body[sets.find(i)];
    groups.body.push_back(model.links[i].is_static   ? kWorld
                          : !massless(i)             ? i
                          : of != RigidGroups::kNone ? of
                                                     : sets.find(i) - 1);
  }
  settle_massless(model, groups);
  return groups;
}

void take_to_start(LinkModel& model) {
  for (LinkJoint& row : model.joints) choose_start(row, model.left_out);
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

}  // namespace rigor
