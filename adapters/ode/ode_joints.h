// A scene's joints as ODE's own, their ends in the order of ode_joint_ends.h.
#pragma once

#include <ode/ode.h>

#include <vector>

#include "core/engine/capabilities.h"
#include "core/scene/scene.h"

namespace rigor::inline adapters {

// Throws InputError where two motors keep a speed of the same joint at the same time: ODE has one motor a joint.
void refuse_shared_motors(const Scene& scene);

class OdeJoints {
 public:
  // The world's ERP and CFM must be set already, because some joints copy them. Bodies are at their poses of t = 0;
  // null stands for a fixed body. The world destroys the joints.
  // `native_servos`: ODE has them, else they are among the loads. Throws EngineFailure for one that ODE cannot have.
  OdeJoints(const Scene& scene, dWorldID world, const std::vector<dBodyID>& bodies, Track track, bool native_servos);

  // For a step whose middle is t: turns on the motors that keep a speed from <= t < until, and the others off; and puts
  // the stops of hinges into the turn that these are in.
  void drive(double t);
  // For a step from t to t + dt, after set_cfm(): puts both stops of each servo's joint at its target. Their softness
  // makes them a spring kp and a damper kd by implicit Euler (ODE's manual, "How to use ERP and CFM").
  void aim(double t, double dt);
  // Values that hinges, sliders and universal joints read in each step, for the joints that copy them.
  void set_cfm(double cfm);

  bool empty() const { return joints_.empty(); }
  // The turns of hinges. All else is set before each step.
  template <typename Archive>
  void archive_state(Archive& archive) {
    archive.each(joints_, [&](Held& held) { archive(held.angle); });
  }
  // Applies from the next step on.
  void ask_for_reactions();
  std::vector<ReportedReaction> reactions() const;
  SettingsInForce settings_in_force() const;

 private:
  struct Axis {  // of a hinge or slider
    void (*set)(dJointID, int parameter, dReal value);
    dReal (*get)(dJointID, int parameter);
  };
  struct Held {
    dJointID id;
    double sign;  // of ODE's angle or displacement, against the scene's
    const Axis* axis;
    double low, high;  // rad, m: its stops, in ODE's coordinate
    int first;         // the body that ODE counts first
    double angle = 0;  // rad: a hinge's, whole turns counted, when it was last asked
    bool has_limits() const;
  };
  struct Maker;

  void set_limits(const Joint& joint, const Held& held, Track track);
  void add_servo(const Scene& scene, const Motor& motor);
  void unwind();

  static const Axis kHinge, kSlider;
  std::vector<Held> joints_;  // in the scene's order
  std::vector<dJointFeedback> feedback_;
  std::vector<Motor> motors_;  // those that keep a speed
  std::vector<Motor> servos_;  // that are ODE's own
  bool has_servos_ = false;    // its own or not
};

}  // namespace rigor::inline adapters
