#include "adapters/common/reduced_twin.h"

#include "adapters/common/spanning_tree.h"
#include "core/dynamics/joints/joints.h"
#include "core/dynamics/kernels/kernels.h"
#include "core/engine/columns.h"

namespace rigor::inline adapters {
namespace {

struct Motion {
  Vec3 position = Vec3::Zero();
  Quat q = Quat::Identity();
  Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
};
struct Acceleration {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();  // m/s², rad/s², in W
};

// The two ends of a joint at the start of a step, the parent also at its end.
struct Ends {
  Motion parent, child, parent_then;
  Acceleration of_parent, of_child;
  double dt;
  TurnOverStep turn;

  Vec3 turning() const { return child.angular_velocity - parent.angular_velocity; }
  Vec3 turning_rate() const { return of_child.angular - of_parent.angular; }
  Quat between() const { return parent.q.conjugate() * child.q; }  // child to parent
};

// The child's motion at the end of the step, of a joint about a point that both share.
Motion hang(const Ends& ends, const Vec3& arm_parent, const Vec3& arm_child, const Quat& q, const Vec3& turning) {
  const Motion& above = ends.parent_then;
  Motion child{.q = q.normalized()};
  const Vec3 to_point = above.q * arm_parent, from_point = -(child.q * arm_child);
  child.position = above.position + to_point + from_point;
  child.angular_velocity = above.angular_velocity + turning;
  child.velocity = above.velocity + above.angular_velocity.cross(to_point) + child.angular_velocity.cross(from_point);
  return child;
}

// Of a point of the child that moves along an axis of the parent.
struct Slide {
  Vec3 line_then;      // m, from the parent's centre to the point, at the step's end
  Vec3 velocity_then;  // m/s, of the point
};
Slide slide_of(const Ends& ends, const Vec3& point, const Vec3& velocity, const Vec3& acceleration,
               const Vec3& axis_parent) {
  const Motion &above = ends.parent, &then = ends.parent_then;
  const Vec3 axis = above.q * axis_parent, line = point - above.position, relative_velocity = velocity - above.velocity;
  const Vec3 carried = ends.of_parent.angular.cross(line) + above.angular_velocity.cross(relative_velocity);
  const double rate = axis.dot(relative_velocity - above.angular_velocity.cross(line)) +
                      ends.dt * axis.dot(acceleration - ends.of_parent.linear - carried);
  const Vec3 line_then = then.q * (above.q.conjugate() * line + ends.dt * rate * axis_parent);
  return {line_then, then.velocity + then.angular_velocity.cross(line_then) + rate * (then.q * axis_parent)};
}

class JointStep {
 public:
  virtual ~JointStep() = default;
  virtual Motion child_after(const Ends& ends) const = 0;
};

struct Arms {
  Vec3 parent, child;  // m, from each centre to the point, in each frame
};

class BallStep : public JointStep {
 public:
  BallStep(const Arms& arms, const Quat& between) : arms_(arms), start_(between) {}
  Motion child_after(const Ends& ends) const override {
    const Vec3 turning = ends.turning();
    const Vec3 rate = ends.child.q.conjugate() *
                      (turning + ends.dt * (ends.turning_rate() - ends.child.angular_velocity.cross(turning)));
    const Quat q = ends.parent_then.q * start_ * ends.turn(start_.conjugate() * ends.between(), rate, ends.dt);
    return hang(ends, arms_.parent, arms_.child, q, q.normalized() * rate);
  }

 private:
  Arms arms_;
  Quat start_;  // child to parent, at t = 0
};

// Also a fixed joint: an axis of zero is one that nothing turns about.
class HingeStep : public JointStep {
 public:
  HingeStep(const Arms& arms, const Vec3& axis_child) : arms_(arms), axis_(axis_child) {}
  Motion child_after(const Ends& ends) const override {
    const Vec3 axis = ends.child.q * axis_;
    const double rate = axis.dot(ends.turning()) + ends.dt * axis.dot(ends.turning_rate());
    const Quat q = ends.parent_then.q * ends.between() * rotation_by(ends.dt * rate * axis_);
    return hang(ends, arms_.parent, arms_.child, q, rate * (q.normalized() * axis_));
  }

 private:
  Arms arms_;
  Vec3 axis_;  // unit, in the child's frame
};

class UniversalStep : public JointStep {
 public:
  UniversalStep(const Arms& arms, const Vec3& first_parent, const Vec3& second_child)
      : arms_(arms), first_(first_parent), second_(second_child) {}
  Motion child_after(const Ends& ends) const override {
    const Vec3 first = ends.parent.q * first_, second = ends.child.q * second_, turning = ends.turning();
    const Vec3 carried = ends.parent.angular_velocity.cross(first),
               of_child = ends.child.angular_velocity.cross(second);
    const double rate1 = first.dot(turning) + ends.dt * (first.dot(ends.turning_rate()) + carried.dot(turning));
    const double rate2 = second.dot(turning) + ends.dt * (second.dot(ends.turning_rate()) + of_child.dot(turning));
    const Quat q = ends.parent_then.q * rotation_by(ends.dt * rate1 * first_) * ends.between() *
                   rotation_by(ends.dt * rate2 * second_);
    return hang(ends, arms_.parent, arms_.child, q,
                rate1 * (ends.parent_then.q * first_) + rate2 * (q.normalized() * second_));
  }

 private:
  Arms arms_;
  Vec3 first_, second_;  // unit, at right angles
};

class SliderStep : public JointStep {
 public:
  explicit SliderStep(const Vec3& axis_parent) : axis_(axis_parent) {}
  Motion child_after(const Ends& ends) const override {
    const Slide slide = slide_of(ends, ends.child.position, ends.child.velocity, ends.of_child.linear, axis_);
    const Motion& then = ends.parent_then;
    return {then.position + slide.line_then, (then.q * ends.between()).normalized(), slide.velocity_then,
            then.angular_velocity};
  }

 private:
  Vec3 axis_;  // unit, in the parent's frame
};

// A slide and a turn, two coordinates about one axis.
class CylinderStep : public JointStep {
 public:
  CylinderStep(const Vec3& arm_child, const Vec3& axis_parent, const Vec3& axis_child)
      : arm_(arm_child), axis_(axis_parent), axis_child_(axis_child) {}
  Motion child_after(const Ends& ends) const override {
    const Motion &child = ends.child, &then = ends.parent_then;
    const Vec3 arm = child.q * arm_, w = child.angular_velocity;
    const Slide slide =
        slide_of(ends, child.position + arm, child.velocity + w.cross(arm),
                 ends.of_child.linear + ends.of_child.angular.cross(arm) + w.cross(w.cross(arm)), axis_);
    const Vec3 axis = child.q * axis_child_;
    const double rate = axis.dot(ends.turning()) + ends.dt * axis.dot(ends.turning_rate());
    Motion after{.q = (then.q * ends.between() * rotation_by(ends.dt * rate * axis_child_)).normalized()};
    const Vec3 from_point = -(after.q * arm_);
    after.position = then.position + slide.line_then + from_point;
    after.angular_velocity = then.angular_velocity + rate * (then.q * axis_);
    after.velocity = slide.velocity_then + after.angular_velocity.cross(from_point);
    return after;
  }

 private:
  Vec3 arm_;                // m, from the child's centre to the anchor, in its frame
  Vec3 axis_, axis_child_;  // unit, in each frame
};

struct MakeStep {
  BodyPose child, parent;
  bool child_is_b;

  Vec3 in_child(const Vec3& direction) const { return child.orientation.conjugate() * direction; }
  Vec3 in_parent(const Vec3& direction) const { return parent.orientation.conjugate() * direction; }
  Arms arms(const Vec3& point) const { return {in_parent(point - parent.position), in_child(point - child.position)}; }

  std::unique_ptr<JointStep> operator()(const BallJoint& joint) const {
    return std::make_unique<BallStep>(arms(joint.anchor), parent.orientation.conjugate() * child.orientation);
  }
  std::unique_ptr<JointStep> operator()(const HingeJoint& joint) const {
    return std::make_unique<HingeStep>(arms(joint.anchor), in_child(joint.axis));
  }
  std::unique_ptr<JointStep> operator()(const FixedJoint&) const {
    return std::make_unique<HingeStep>(arms(child.position), Vec3::Zero());
  }
  std::unique_ptr<JointStep> operator()(const SliderJoint& joint) const {
    return std::make_unique<SliderStep>(in_parent(joint.axis));
  }
  std::unique_ptr<JointStep> operator()(const UniversalJoint& joint) const {
    const Vec3 axis2 = joint.square_axis2();
    return child_is_b ? std::make_unique<UniversalStep>(arms(joint.anchor), in_parent(joint.axis), in_child(axis2))
                      : std::make_unique<UniversalStep>(arms(joint.anchor), in_parent(axis2), in_child(joint.axis));
  }
  std::unique_ptr<JointStep> operator()(const CylindricalJoint& joint) const {
    return std::make_unique<CylinderStep>(arms(joint.anchor).child, in_parent(joint.axis), in_child(joint.axis));
  }
  std::unique_ptr<JointStep> operator()(const DistanceJoint&) const { return nullptr; }
  // No twin takes these.
  std::unique_ptr<JointStep> operator()(const CompoundAxis&) const { return nullptr; }
  std::unique_ptr<JointStep> operator()(const CompoundJoint&) const { return nullptr; }
  std::unique_ptr<JointStep> operator()(const PlanarJoint&) const { return nullptr; }
  std::unique_ptr<JointStep> operator()(const ScrewJoint&) const { return nullptr; }
};

class ReducedTwin : public Stepper {
 public:
  ReducedTwin(const StepperParts& parts, TurnOverStep turn)
      : parts_(parts), turn_(turn), applied_(kWrenchColumns, parts.system.size()) {
    if (!parts.scene) {  // then nothing holds bodies together
      for (std::size_t i = 0; i < parts.system.size(); ++i)
        if (!parts.system.bodies[i].fixed) bases_.push_back(i);
      return;
    }
    const SpanningTree tree = spanning_tree(*parts.scene);
    std::vector<int> waiting = tree.roots;
    while (!waiting.empty()) {
      const int body = waiting.back();
      waiting.pop_back();
      add(*parts.scene, tree.links[static_cast<std::size_t>(body)], body);
      const std::vector<int>& below = tree.below[static_cast<std::size_t>(body)];
      waiting.insert(waiting.end(), below.begin(), below.end());
    }
  }

  void archive_state(StateArchive&) override {}  // nothing outlives a step

  void step(MutableBodyColumns state, double t, double dt) override {
    find_accelerations(state, t, dt);
    for (std::size_t i = 0; i < state.size(); ++i) before_[i] = after_[i] = motion_of(state, i);
    for (const std::size_t i : bases_) drift(i, dt);
    for (const Branch& branch : branches_) {
      const Ends ends{.parent = at(before_, branch.parent),
                      .child = before_[branch.body],
                      .parent_then = at(after_, branch.parent),
                      .of_parent = branch.parent == kWorld ? Acceleration{}
                                                           : accelerations_[static_cast<std::size_t>(branch.parent)],
                      .of_child = accelerations_[branch.body],
                      .dt = dt,
                      .turn = turn_};
      after_[branch.body] = branch.joint->child_after(ends);
    }
    for (std::size_t i = 0; i < state.size(); ++i) {
      const Motion& motion = after_[i];
      state.set_body(i, {motion.position, motion.q, motion.velocity, motion.angular_velocity});
    }
  }

 private:
  struct Branch {
    std::size_t body;
    int parent;  // a body that comes before, or kWorld
    std::unique_ptr<JointStep> joint;
  };

  void add(const Scene& scene, const SpanningTree::Link& link, int body) {
    if (link.joint < 0) {
      bases_.push_back(static_cast<std::size_t>(body));
      return;
    }
    const Joint& joint = scene.joints[static_cast<std::size_t>(link.joint)];
    // A parent that stands is W itself, wherever it is.
    const BodyPose parent = link.parent == kWorld ? BodyPose{} : scene.pose(link.parent);
    const MakeStep make{scene.pose(body), parent, joint.b == body};
    branches_.push_back({static_cast<std::size_t>(body), link.parent, std::visit(make, joint.type)});
  }

  static Motion motion_of(BodyColumns state, std::size_t i) {
    return {state.position(i), state.orientation(i), state.velocity(i), state.angular_velocity(i)};
  }
  static Motion at(const std::vector<Motion>& motions, int body) {
    return body == kWorld ? Motion{} : motions[static_cast<std::size_t>(body)];
  }

  void find_accelerations(BodyColumns state, double t, double dt) {
    parts_.system.loads.evaluate(state, t, dt, wrenches_);
    for (std::size_t i = 0; i < state.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        applied_.column(kForce + k)[i] = wrenches_[i].force[k];
        applied_.column(kTorque + k)[i] = wrenches_[i].torque[k];
      }
    }
    const double* held = applied_.data();
    if (parts_.joints) held = parts_.joints->hold(state, held, ConstraintForces::Rows::chosen_anew);
    const auto vector_at = [&](int column, std::size_t i) {
      const double* first = held + static_cast<std::size_t>(column) * applied_.stride() + i;
      return Vec3(first[0], first[applied_.stride()], first[2 * applied_.stride()]);
    };
    for (std::size_t i = 0; i < state.size(); ++i) {
      const Inertia& body = parts_.system.bodies[i];
      if (body.fixed) continue;
      accelerations_[i] = {
          parts_.system.scene_gravity + body.inverse_mass * vector_at(kForce, i),
          angular_acceleration(body, state.rotation(i), state.angular_velocity(i), vector_at(kTorque, i))};
    }
  }

  void drift(std::size_t i, double dt) {
    Motion& motion = after_[i];
    motion.velocity += dt * accelerations_[i].linear;
    motion.angular_velocity += dt * accelerations_[i].angular;
    motion.position += dt * motion.velocity;
    motion.q = turn_(motion.q, motion.q.conjugate() * motion.angular_velocity, dt).normalized();
  }

  StepperParts parts_;
  TurnOverStep turn_;
  std::vector<std::size_t> bases_;  // bodies that float free
  std::vector<Branch> branches_;    // parents first
  Columns applied_;
  Wrenches wrenches_;
  std::vector<Motion> before_ = std::vector<Motion>(parts_.system.size()), after_ = before_;
  std::vector<Acceleration> accelerations_ = std::vector<Acceleration>(parts_.system.size());
};

}  // namespace

std::unique_ptr<Stepper> make_reduced_twin(const StepperParts& parts, TurnOverStep turn) {
  return std::make_unique<ReducedTwin>(parts, turn);
}

}  // namespace rigor::inline adapters
