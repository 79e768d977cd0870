#include "adapters/ode/ode_twin_joints.h"

#include "adapters/ode/ode_joint_ends.h"
#include "adapters/ode/ode_matched.h"

namespace rigor::inline adapters {
namespace {

// The rows from `at` on: the points at the two arms coincide.
void keep_together(const OdeEnd& first, const Vec3& arm, const OdeEnd& second, const Vec3& other, OdeRows& rows,
                   int at = 0) {
  rows.on_first.block<3, 3>(at, 0).setIdentity();
  rows.on_first.block<3, 3>(at, 3) = -cross_matrix(arm);
  rows.on_second.block<3, 3>(at, 0) = -Mat3::Identity();
  rows.on_second.block<3, 3>(at, 3) = cross_matrix(other);
  rows.missing.segment<3>(at) = second.position + other - first.position - arm;
}

// One row: no relative turning about p.
void keep_from_turning(const Vec3& p, double missing, OdeRows& rows, int at) {
  rows.on_first.block<1, 3>(at, 3) = p.transpose();
  rows.on_second.block<1, 3>(at, 3) = -p.transpose();
  rows.missing[at] = missing;
}

// Three rows: the second body keeps its orientation in the first. The error is twice the vector part of the quaternion
// that leads there.
void keep_orientation(const OdeEnd& first, const OdeEnd& second, const Quat& relative, OdeRows& rows, int at) {
  rows.on_first.block<3, 3>(at, 3).setIdentity();
  rows.on_second.block<3, 3>(at, 3) = -Mat3::Identity();
  const Quat left = (first.orientation.conjugate() * second.orientation) * relative.conjugate();
  rows.missing.segment<3>(at) = (left.w() < 0 ? -2 : 2) * (first.R * left.vec());
}

Quat relative_orientation(const OdeEnd& first, const OdeEnd& second) {
  return first.orientation.conjugate() * second.orientation;
}

Vec3 seen_from(const OdeEnd& end, const Vec3& point_W) { return end.R.transpose() * (point_W - end.position); }

class OdeBall : public OdeJointRows {
 public:
  OdeBall(const Vec3& anchor, const OdeEnd& first, const OdeEnd& second)
      : arm_(seen_from(first, anchor)), other_(seen_from(second, anchor)) {}
  int count() const override { return 3; }
  void fill(const OdeEnd& first, const OdeEnd& second, OdeRows& rows) const override {
    keep_together(first, first.R * arm_, second, second.R * other_, rows);
  }

 private:
  Vec3 arm_, other_;
};

class OdeHinge : public OdeBall {
 public:
  OdeHinge(const HingeJoint& hinge, const OdeEnd& first, const OdeEnd& second)
      : OdeBall(hinge.anchor, first, second),
        axis_(first.R.transpose() * hinge.axis),
        other_axis_(second.R.transpose() * hinge.axis) {}
  int count() const override { return 5; }
  void fill(const OdeEnd& first, const OdeEnd& second, OdeRows& rows) const override {
    OdeBall::fill(first, second, rows);
    const Vec3 axis = first.R * axis_, off = axis.cross(second.R * other_axis_);
    const Across across = directions_across(axis);
    keep_from_turning(across.first, across.first.dot(off), rows, 3);
    keep_from_turning(across.second, across.second.dot(off), rows, 4);
  }

 private:
  Vec3 axis_, other_axis_;
};

class OdeUniversal : public OdeBall {
 public:
  OdeUniversal(const Vec3& anchor, const Vec3& axis, const Vec3& other_axis, const OdeEnd& first, const OdeEnd& second)
      : OdeBall(anchor, first, second),
        axis_(first.R.transpose() * axis),
        other_axis_(second.R.transpose() * other_axis) {}
  int count() const override { return 4; }
  void fill(const OdeEnd& first, const OdeEnd& second, OdeRows& rows) const override {
    OdeBall::fill(first, second, rows);
    const Vec3 axis = first.R * axis_, other = second.R * other_axis_;
    keep_from_turning(axis.cross(other).normalized(), -axis.dot(other), rows, 3);
  }

 private:
  Vec3 axis_, other_axis_;
};

// ODE's piston. The first is pushed at the place of the second's anchor.
class OdePiston : public OdeJointRows {
 public:
  OdePiston(const CylindricalJoint& cylinder, const OdeEnd& first, const OdeEnd& second)
      : arm_(seen_from(first, cylinder.anchor)),
        other_(seen_from(second, cylinder.anchor)),
        axis_(first.R.transpose() * cylinder.axis),
        other_axis_(second.R.transpose() * cylinder.axis) {}
  int count() const override { return 4; }
  void fill(const OdeEnd& first, const OdeEnd& second, OdeRows& rows) const override {
    const Vec3 axis = first.R * axis_, off = axis.cross(second.R * other_axis_), other = second.R * other_;
    const Vec3 line = second.position + other - first.position, missing = line - first.R * arm_;
    const Across across = directions_across(axis);
    int at = 0;
    for (const Vec3& p : {across.first, across.second}) {
      keep_from_turning(p, p.dot(off), rows, at++);
      rows.on_first.row(at) << p.transpose(), line.cross(p).transpose();
      rows.on_second.row(at) << -p.transpose(), p.cross(other).transpose();
      rows.missing[at++] = p.dot(missing);
    }
  }

 private:
  Vec3 arm_, other_, axis_, other_axis_;
};

// The axis is the first's, the offset the second's; half of the turning of each counts.
class OdeSlider : public OdeJointRows {
 public:
  OdeSlider(const SliderJoint& slider, const OdeEnd& first, const OdeEnd& second)
      : axis_(first.R.transpose() * slider.axis),
        offset_(seen_from(second, first.position)),
        relative_(relative_orientation(first, second)) {}
  int count() const override { return 5; }
  void fill(const OdeEnd& first, const OdeEnd& second, OdeRows& rows) const override {
    keep_orientation(first, second, relative_, rows, 0);
    const Across across = directions_across(first.R * axis_);
    const Vec3 line = second.position - first.position;
    int at = 3;
    for (const Vec3& p : {across.first, across.second}) {
      rows.on_first.block<1, 3>(at, 0) = p.transpose();
      rows.on_second.block<1, 3>(at, 0) = -p.transpose();
      if (second.moves) {
        rows.on_first.block<1, 3>(at, 3) = 0.5 * line.cross(p).transpose();
        rows.on_second.block<1, 3>(at, 3) = rows.on_first.block<1, 3>(at, 3);
      }
      rows.missing[at] = p.dot(line + second.R * offset_);
      ++at;
    }
  }

 private:
  Vec3 axis_, offset_;
  Quat relative_;
};

// The second's centre is a point of the first; to the world it is the first's centre that stays.
class OdeFixed : public OdeJointRows {
 public:
  OdeFixed(const OdeEnd& first, const OdeEnd& second)
      : offset_(second.moves ? seen_from(first, second.position) : first.position),
        relative_(relative_orientation(first, second)) {}
  int count() const override { return 6; }
  void fill(const OdeEnd& first, const OdeEnd& second, OdeRows& rows) const override {
    if (second.moves)
      keep_together(first, first.R * offset_, second, Vec3::Zero(), rows);
    else
      keep_together(first, Vec3::Zero(), second, offset_, rows);
    keep_orientation(first, second, relative_, rows, 3);
  }

 private:
  Vec3 offset_;
  Quat relative_;
};

class OdeDistance : public OdeJointRows {
 public:
  OdeDistance(const Vec3& point_W, const Vec3& other_W, const OdeEnd& first, const OdeEnd& second)
      : arm_(seen_from(first, point_W)), other_(seen_from(second, other_W)), distance_((point_W - other_W).norm()) {}
  int count() const override { return 1; }
  void fill(const OdeEnd& first, const OdeEnd& second, OdeRows& rows) const override {
    const Vec3 arm = first.R * arm_, other = second.R * other_;
    const Vec3 line = first.position + arm - second.position - other, along = line.normalized();
    rows.on_first.row(0) << along.transpose(), arm.cross(along).transpose();
    rows.on_second.row(0) << -along.transpose(), -other.cross(along).transpose();
    rows.missing[0] = distance_ - line.norm();
  }

 private:
  Vec3 arm_, other_;
  double distance_;
};

struct MakeRows {
  using Rows = std::unique_ptr<OdeJointRows>;
  const OdeJointEnds& ends;
  const OdeEnd &first, &second;

  Rows operator()(const BallJoint& ball) const { return std::make_unique<OdeBall>(ball.anchor, first, second); }
  Rows operator()(const CylindricalJoint& cylinder) const {
    return std::make_unique<OdePiston>(cylinder, first, second);
  }
  Rows operator()(const HingeJoint& hinge) const { return std::make_unique<OdeHinge>(hinge, first, second); }
  Rows operator()(const SliderJoint& slider) const { return std::make_unique<OdeSlider>(slider, first, second); }
  Rows operator()(const FixedJoint&) const { return std::make_unique<OdeFixed>(first, second); }
  Rows operator()(const DistanceJoint& distance) const {
    const auto [one, other] = ends.points(distance);
    return std::make_unique<OdeDistance>(one, other, first, second);
  }
  Rows operator()(const CompoundAxis&) const { return nullptr; }  // none of these is among the features
  Rows operator()(const CompoundJoint&) const { return nullptr; }
  Rows operator()(const PlanarJoint&) const { return nullptr; }
  Rows operator()(const ScrewJoint&) const { return nullptr; }
  Rows operator()(const UniversalJoint& universal) const {
    const auto [one, other] = ends.axes(universal);
    return std::make_unique<OdeUniversal>(universal.anchor, one, other, first, second);
  }
};

OdeEnd end_of(BodyColumns state, int body) {
  if (body == kWorld) return {};
  return {state.position(body), state.orientation(body), state.rotation(body), true};
}

}  // namespace

OdeTwinJoints::OdeTwinJoints(const Scene& scene, const System& system, double erp, std::optional<double> cfm)
    : solver_(system, erp, cfm, matched_softness(scene)) {
  BodyTable start(system.size());
  set_initial_state(scene, start.columns());
  for (const Joint& joint : scene.joints) {
    const OdeJointEnds ends(scene, joint);
    const auto [first, second] = ends.bodies;
    const OdeEnd one = end_of(start.columns(), first), other = end_of(start.columns(), second);
    joints_.push_back({std::visit(MakeRows{ends, one, other}, joint.type), first, second});
  }
}

void OdeTwinJoints::push(MutableBodyColumns state, double dt) {
  for (const JointWithRows& joint : joints_) {
    OdeRows rows;
    joint.rows->fill(end_of(state, joint.first), end_of(state, joint.second), rows);
    for (int k = 0; k < joint.rows->count(); ++k)
      solver_.add_row(joint.first, rows.on_first.row(k), joint.second, rows.on_second.row(k), rows.missing[k]);
  }
  solver_.push(state, dt);
}

}  // namespace rigor::inline adapters
