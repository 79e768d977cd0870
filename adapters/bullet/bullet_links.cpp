#include "adapters/bullet/bullet_links.h"

#include <variant>

namespace rigor::inline adapters::bullet {
namespace {

constexpr bool kCollidesWithParent = true;  // the world's rule keeps pairs apart (bullet_link_shapes.h)

// The joint's point for both ends: its anchor, or the child's centre.
Vec3 point_of(const Joint& joint, const LinkFrame& child) {
  const Vec3* anchor = anchor_of(joint);
  return anchor ? *anchor : child.origin;
}

// A universal joint's axes, exactly at right angles: the first fixed in the parent, the second in the child.
struct UniversalAxes {
  Vec3 first, second;  // unit, in W at t = 0
};
UniversalAxes axes_of(const UniversalJoint& joint, bool child_is_b) {
  const Vec3 axis2 = joint.square_axis2();
  return child_is_b ? UniversalAxes{joint.axis, axis2} : UniversalAxes{axis2, joint.axis};
}

// Adds the links of one joint to a tree.
struct AddLinks {
  btMultiBody& tree;
  int link, parent;  // Bullet's numbers
  const LinkFrame &child, &above;
  double mass;
  btVector3 moments;
  bool child_is_b;
  Vec3 point;  // in W

  btQuaternion turn() const { return to_bullet(Quat(child.q.conjugate() * above.q)); }
  btVector3 from_parent() const { return above.seen(point - above.origin); }
  btVector3 to_child() const { return child.seen(child.origin - point); }

  void operator()(const BallJoint&) const {
    tree.setupSpherical(link, mass, moments, parent, turn(), from_parent(), to_child(), !kCollidesWithParent);
  }
  // Two links, as for a universal joint: a slide, then a rotation of the link with the mass.
  void operator()(const CylindricalJoint& joint) const {
    const btVector3 nothing(0, 0, 0), axis = child.seen(joint.axis);
    tree.setupPrismatic(link, 0, nothing, parent, turn(), axis, from_parent(), nothing, !kCollidesWithParent);
    tree.setupRevolute(link + 1, mass, moments, link, btQuaternion::getIdentity(), axis, nothing, to_child(),
                       !kCollidesWithParent);
  }
  void operator()(const HingeJoint& joint) const {
    tree.setupRevolute(link, mass, moments, parent, turn(), child.seen(joint.axis), from_parent(), to_child(),
                       !kCollidesWithParent);
  }
  void operator()(const SliderJoint& joint) const {
    tree.setupPrismatic(link, mass, moments, parent, turn(), child.seen(joint.axis), from_parent(), to_child(),
                        !kCollidesWithParent);
  }
  void operator()(const FixedJoint&) const {
    tree.setupFixed(link, mass, moments, parent, turn(), from_parent(), to_child(), !kCollidesWithParent);
  }
  void operator()(const UniversalJoint& joint) const {
    const UniversalAxes axes = axes_of(joint, child_is_b);
    const btVector3 nothing(0, 0, 0);
    tree.setupRevolute(link, 0, nothing, parent, turn(), child.seen(axes.first), from_parent(), nothing,
                       !kCollidesWithParent);
    tree.setupRevolute(link + 1, mass, moments, link, btQuaternion::getIdentity(), child.seen(axes.second), nothing,
                       to_child(), !kCollidesWithParent);
  }
  void operator()(const DistanceJoint&) const {}  // refused before
  void operator()(const CompoundAxis&) const {}   // none of these is among the features
  void operator()(const CompoundJoint&) const {}
  void operator()(const PlanarJoint&) const {}
  void operator()(const ScrewJoint&) const {}
};

// Sets a joint's velocities from those of its ends in W.
struct SetVelocities {
  btMultiBody& tree;
  int link;  // of the child
  const LinkFrame &child, &above;
  bool child_is_b;
  Vec3 point;  // in W

  Vec3 turning() const { return child.angular_velocity - above.angular_velocity; }
  Vec3 sliding() const {
    const Vec3 carried = above.velocity + above.angular_velocity.cross(point - above.origin);
    return child.velocity + child.angular_velocity.cross(point - child.origin) - carried;
  }

  void operator()(const BallJoint&) const {
    const Vec3 rate = child.q.conjugate() * turning();
    tree.setJointVelMultiDof(link, rate.data());
  }
  void operator()(const CylindricalJoint& joint) const {
    tree.setJointVel(link - 1, joint.axis.dot(sliding()));
    tree.setJointVel(link, joint.axis.dot(turning()));
  }
  void operator()(const HingeJoint& joint) const { tree.setJointVel(link, joint.axis.dot(turning())); }
  void operator()(const SliderJoint& joint) const { tree.setJointVel(link, joint.axis.dot(sliding())); }
  void operator()(const UniversalJoint& joint) const {
    const UniversalAxes axes = axes_of(joint, child_is_b);
    tree.setJointVel(link - 1, axes.first.dot(turning()));
    tree.setJointVel(link, axes.second.dot(turning()));
  }
  void operator()(const FixedJoint&) const {}
  void operator()(const DistanceJoint&) const {}
  void operator()(const CompoundAxis&) const {}  // none of these is among the features
  void operator()(const CompoundJoint&) const {}
  void operator()(const PlanarJoint&) const {}
  void operator()(const ScrewJoint&) const {}
};

}  // namespace

btVector3 LinkFrame::seen(const Vec3& direction_W) const { return to_bullet(Vec3(q.conjugate() * direction_W)); }

LinkFrame frame_at_start(const Body& body, const Quat& q_WP) {
  if (body.fixed) return {};
  return {body.position, q_WP, body.velocity, body.angular_velocity};
}

int links_of(const Joint& joint) {
  return std::visit(ForJoints{[](const CylindricalJoint&) { return 2; }, [](const UniversalJoint&) { return 2; },
                              [](const auto&) { return 1; }},
                    joint.type);
}

void add_links(btMultiBody& tree, const Joint& joint, const JointEnds& ends, const NewLinks& links) {
  const AddLinks add{.tree = tree,
                     .link = links.first,
                     .parent = links.parent,
                     .child = ends.child,
                     .above = ends.parent,
                     .mass = links.mass,
                     .moments = links.moments,
                     .child_is_b = ends.child_is_b,
                     .point = point_of(joint, ends.child)};
  std::visit(add, joint.type);
}

void set_velocities(btMultiBody& tree, int link, const Joint& joint, const JointEnds& ends) {
  std::visit(SetVelocities{tree, link, ends.child, ends.parent, ends.child_is_b, point_of(joint, ends.child)},
             joint.type);
}

}  // namespace rigor::inline adapters::bullet
