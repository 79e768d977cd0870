#include "cases/import/assembly/rigid_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "cases/import/assembly/mass_moments.h"
#include "core/base/error.h"

namespace rigor::inline imports {
namespace {

// Sets of links. A set is named by its least member.
class Sets {
 public:
  explicit Sets(std::size_t links) : of_(links) { std::iota(of_.begin(), of_.end(), 0); }
  int find(int i) {
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

bool is_rigid(const LinkJoint& row) { return std::holds_alternative<FixedJoint>(row.joint.type) && !row.is_loop; }

// Returns the joints at each link, by link + 1.
std::vector<std::vector<int>> joints_at(const LinkModel& model) {
  std::vector<std::vector<int>> at(model.links.size() + 1);
  for (std::size_t k = 0; k < model.joints.size(); ++k) {
    at[model.joints[k].joint.a + 1].push_back(static_cast<int>(k));
    at[model.joints[k].joint.b + 1].push_back(static_cast<int>(k));
  }
  return at;
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
      if (!is_rigid(model.joints[k]) || other == kWorld || model.links[other].is_static) continue;
      model.links[other].is_static = true, waiting.push_back(other);
    }
  }
}

// Sets of links without mass: one at the end of a tree is left out with its joint, one between two joints with an axis
// each makes one joint of them, and any other is refused.
class Massless {
 public:
  Massless(LinkModel& model, RigidGroups& groups) : model_(model), groups_(groups), is_gone_(model.joints.size()) {
    members_.resize(model.links.size());
    for (int i = 0; i < static_cast<int>(model.links.size()); ++i) {
      if (groups.body[i] >= 0) members_[groups.body[i]].push_back(i);
    }
  }

  void settle() {
    const auto at = joints_at(model_);
    std::vector<int> waiting;
    for (int i = 0; i < static_cast<int>(members_.size()); ++i) {
      if (is_massless(i)) waiting.push_back(i);
    }
    while (!waiting.empty()) {  // a set that goes may leave another one at the end
      const int set = waiting.back();
      waiting.pop_back();
      if (groups_.body[set] == RigidGroups::kNone) continue;
      const std::vector<int> moving = joints_that_move(set, at);
      if (moving.size() > 1) continue;
      leave_out(set);
      for (const int k : moving) {
        is_gone_[k] = true;
        model_.left_out.add(model_.joints[k].where, "the joint", no_motion("what it carries has no mass"));
        for (const int end : {model_.joints[k].joint.a, model_.joints[k].joint.b}) {
          if (end != kWorld && groups_.body[end] >= 0 && is_massless(groups_.body[end]))
            waiting.push_back(groups_.body[end]);
        }
      }
    }
    for (int i = 0; i < static_cast<int>(members_.size()); ++i) {
      if (is_massless(i)) settle_between(i, joints_that_move(i, at));
    }
    remove_joints();
  }

 private:
  bool is_massless(int set) const {
    return groups_.body[set] == set && !members_[set].empty() && groups_.inertial[set].mass == 0;
  }

  std::vector<int> joints_that_move(int set, const std::vector<std::vector<int>>& at) const {
    const auto body_of = [&](int link) { return link == kWorld ? kWorld : groups_.body[link]; };
    std::vector<int> moving;
    for (const int link : members_[set]) {
      for (const int k : at[link + 1]) {
        const Joint& joint = model_.joints[k].joint;
        if (!is_gone_[k] && body_of(joint.a) != body_of(joint.b)) moving.push_back(k);
      }
    }
    return moving;
  }

  void leave_out_shapes(const Link& link) {
    for (const LinkShape& shape : link.shapes)
      model_.left_out.add(shape.where, "a shape without mass", lost("what moves it has no mass: nothing touches it"));
  }

  void leave_out(int set) {
    for (const int link : members_[set]) {
      model_.left_out.add(model_.links[link].where, "the link", no_motion("it has no mass and carries none"));
      leave_out_shapes(model_.links[link]);
      groups_.body[link] = RigidGroups::kNone;
    }
  }

  void settle_between(int set, const std::vector<int>& moving) {
    const auto has_axis = [&](int k) { return free_axis(model_.joints[k].joint) && !model_.joints[k].is_loop; };
    if (moving.size() != 2 || !std::all_of(moving.begin(), moving.end(), has_axis))
      throw InputError(fmt::format(
          "{}: there is no <inertial>, and it moves between other links: nothing without mass can be simulated; "
          "allowed: a mass, fixed joints, or a hinge or slider on either side",
          model_.links[set].where));
    for (const int link : members_[set]) {
      leave_out_shapes(model_.links[link]);
      groups_.body[link] = RigidGroups::kBetween;
    }
  }

  void remove_joints() {
    std::vector<LinkJoint> left;
    std::vector<int> place(model_.joints.size(), -1);
    for (std::size_t k = 0; k < model_.joints.size(); ++k) {
      if (!is_gone_[k]) place[k] = static_cast<int>(left.size()), left.push_back(model_.joints[k]);
    }
    model_.joints = std::move(left);
    // What acts on the coordinate of a link without mass meets no resistance: it moves nothing else.
    keep_renumbered(model_.motors, place), keep_renumbered(model_.couplings, place);
  }

  LinkModel& model_;
  RigidGroups& groups_;
  std::vector<bool> is_gone_;              // by joint
  std::vector<std::vector<int>> members_;  // by set
};

}  // namespace

LinkInertial sum_of(const std::vector<LinkInertial>& parts) {
  if (parts.size() == 1) return parts.front();  // with all its digits
  LinkInertial sum;
  for (const LinkInertial& part : parts) sum.mass += part.mass, sum.pose.position += part.mass * part.pose.position;
  if (sum.mass == 0) return sum;
  sum.pose.position /= sum.mass;
  for (const LinkInertial& part : parts) {
    const Mat3 turn = matrix_of(part.pose.orientation);
    sum.inertia += turn * part.inertia * turn.transpose() + steiner(part.mass, part.pose.position - sum.pose.position);
  }
  return sum;
}

RigidGroups rigid_groups(LinkModel& model) {
  hold_by_world(model);
  const int count = static_cast<int>(model.links.size());
  const auto moves = [&](int link) { return link != kWorld && !model.links[link].is_static; };
  // No mass, or a point's: no body by itself.
  const auto is_part = [&](int link) {
    const auto& inertial = model.links[link].inertial;
    return moves(link) && (inertial.empty() || inertial.front().inertia.isZero(0));
  };
  Sets sets(model.links.size());
  for (const LinkJoint& row : model.joints) {
    const int a = row.joint.a, b = row.joint.b;
    if (is_rigid(row) && moves(a) && moves(b) && is_part(a) && is_part(b)) sets.join(a, b);
  }
  std::vector<int> carrier(model.links.size(), -1);  // by set of parts: the link whose body it belongs to
  for (const LinkJoint& row : model.joints) {
    for (const auto& [part, whole] : {std::pair{row.joint.a, row.joint.b}, {row.joint.b, row.joint.a}}) {
      if (!is_rigid(row) || !moves(part) || !moves(whole) || !is_part(part) || is_part(whole)) continue;
      int& of = carrier[sets.find(part)];
      if (of < 0) of = whole;
    }
  }
  for (int i = 0; i < count; ++i) {  // points alone, which may be a body together
    const bool is_point = moves(i) && is_part(i) && !model.links[i].inertial.empty();
    if (is_point && carrier[sets.find(i)] < 0) carrier[sets.find(i)] = i;
  }
  RigidGroups groups;
  groups.inertial.resize(model.links.size());
  std::vector<std::vector<LinkInertial>> parts(model.links.size());
  for (int i = 0; i < count; ++i) {
    const int set = sets.find(i), of = !moves(i) ? kWorld : !is_part(i) ? i : carrier[set] >= 0 ? carrier[set] : set;
    groups.set.push_back(set), groups.body.push_back(of);
    if (moves(i) && !model.links[i].inertial.empty()) parts[of].push_back(model.links[i].inertial.front());
  }
  for (int i = 0; i < count; ++i) {
    if (!parts[i].empty()) groups.inertial[i] = sum_of(parts[i]);
  }
  Massless(model, groups).settle();
  return groups;
}

}  // namespace rigor::inline imports
