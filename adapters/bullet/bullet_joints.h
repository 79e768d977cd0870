// A scene's joints as Bullet's constraints between rigid bodies:
//   ball         btPoint2PointConstraint
//   cylindrical  btSliderConstraint with a free angle; the frames' x is the axis, their origin the anchor
//   fixed        btFixedConstraint
//   hinge        btHingeConstraint; the frames' z is the axis. Its angle counts as ours does only with the frame of a
//                (useReferenceFrameA). Bullet multiplies the bounce of its limits by their "bias factor"
//   slider       btSliderConstraint; the frames' x is the axis, their origin b's centre
//   universal    btGeneric6DofSpring2Constraint with one of three angles locked: z of a's frame is the axis, x of b's
//                frame axis2. The angle about z x x keeps them at right angles
// A slider's limits are a second constraint beside it, a btGeneric6DofSpring2Constraint of which all but the
// displacement along the axis is free: btSliderConstraint looks for its bounce on the way out, and so never bounces.
// Bullet has no joint that keeps a distance, and none of its constraints is one for a special choice of its parameters.
// Springs, dampers and given efforts are not here: they are loads (external_loads.h).
#pragma once

#include <btBulletDynamicsCommon.h>

#include <functional>
#include <memory>
#include <vector>

#include "core/engine/capabilities.h"

namespace rigor::inline adapters::bullet {

class Joints {
 public:
  // The body with this index. For kWorld, and for a fixed body without its own, a body at the origin.
  using BodyOf = std::function<btRigidBody&(int)>;

  // How the constraints are set: as shipped, or for sequential impulses or a direct solver of the matched track.
  enum class Set { as_shipped, for_sweeps, for_direct_solver };
  // Bodies stand as the scene has them at t = 0, and outlive this.
  Joints(const Scene& scene, const BodyOf& body_of, Set set);

  // Takes part in the world from now on, which must end first.
  void enter(btDynamicsWorld& world);
  // Sets the motors that keep a speed to what they may do over the step from t to t + dt, the limits of hinges to
  // those of the turn that these are in, and how hinges with limits hold their anchors in this step.
  void set_for_step(double t, double dt);

  bool empty() const { return constraints_.empty(); }
  // The turns of hinges. Bullet begins each step without impulses of its constraints.
  template <typename Archive>
  void archive_state(Archive& archive) {
    archive.each(winding_, [&](Winding& at) { archive(at.angle); });
  }
  // Applies from the next step on, to joints without limits, because Bullet keeps a slider's limits in a second
  // constraint.
  void ask_for_reactions();
  std::vector<ReportedReaction> reactions() const;

 private:
  void add(const Scene& scene, const Joint& joint, const BodyOf& body_of);

  void unwind();
  void choose_frame_offsets();

  Set set_;
  std::vector<btHingeConstraint*> limited_;  // hinges with limits
  struct Winding {                           // a hinge with a limit beyond half a turn
    btHingeConstraint* hinge;
    double lower, upper;  // rad
    double restitution;
    double angle = 0;  // rad, whole turns counted, when it was last asked
  };
  std::vector<Winding> winding_;
  std::vector<std::unique_ptr<btTypedConstraint>> constraints_;  // a slider's limits stand behind it
  std::vector<btTypedConstraint*> of_joint_;
  std::vector<Motor> motors_;  // that keep a speed
  struct Reported {
    int body;
    bool is_b;
  };
  std::vector<Reported> reported_;         // by joint: an end that moves
  std::vector<btJointFeedback> feedback_;  // by joint
};

}  // namespace rigor::inline adapters::bullet
