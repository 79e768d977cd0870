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

namespace rigor::bullet {

class Joints {
 public:
  // The body of an index, or for kWorld and a fixed body without one of its own a body that stands at the origin.
  using BodyOf = std::function<btRigidBody&(int)>;

  // Bodies stand as the scene has them at t = 0, and outlive this.
  Joints(const Scene& scene, const BodyOf& body_of, bool matched);

  // Takes part in the world from now on, which must end first.
  void enter(btDynamicsWorld& world);
  // Sets the motors that keep a speed to what they may do over the step from t to t + dt, and the limits of hinges to
  // those of the turn that these are in.
  void set_motors(double t, double dt);

  bool empty() const { return constraints_.empty(); }
  // From the next step on; of joints without limits, for Bullet keeps a slider's by a second constraint.
  void ask_for_reactions();
  std::vector<ReportedReaction> reactions() const;

 private:
  void add(const Scene& scene, const Joint& joint, const BodyOf& body_of, bool matched);

  void unwind();

  bool matched_;
  struct Winding {  // a hinge with a limit beyond half a turn
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

}  // namespace rigor::bullet
