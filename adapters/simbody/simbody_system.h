// A scene as a multibody system of Simbody. It is compiled as C++17, because Simbody 3.7's index types have ambiguous
// comparisons in C++20. It uses NDEBUG, so that the checks in its headers are the same in every build. why_no_inertia()
// replaces their check of inertias.
//
// Simbody's conventions and ours: SI here and there; quaternions (w, x, y, z), body to parent; W is called Ground, and
// angular velocity comes before linear velocity. A body's frame has its origin at the centre of mass here too.
#pragma once

#include <SimTKsimbody.h>

#include <vector>

#include "adapters/simbody/simbody_mobilizers.h"
#include "core/dynamics/model/loads/loads.h"
#include "core/engine/body_table.h"
#include "core/scene/scene.h"

namespace rigor::inline adapters {

class SimbodySystem {
 public:
  // Throws InputError for an inertia that no body can have, and EngineFailure for a spring of no length.
  explicit SimbodySystem(const Scene& scene);

  const SimTK::MultibodySystem& system() const { return system_; }
  const SimTK::SimbodyMatterSubsystem& matter() const { return matter_; }
  const Scene& scene() const { return scene_; }
  const SimTK::State& start() const { return start_; }  // of t = 0
  SimTK::Vec3 gravity() const { return gravity_.getGravity(); }

  // The loads that are Rigor's own: timed forces, and the springs, dampers and motors of joints.
  const Loads& loads() const { return loads_; }
  void sample_servos(BodyColumns bodies, double t) { loads_.sample_servos(bodies, t); }
  // Selects the loads of the step from `from` to `to` [s]; returns false if they are unchanged.
  bool set_interval(double from, double to);

  // A joint by constraints, and the one of its bodies that surely moves.
  struct Loop {
    int joint, body;
    SimTK::ConstraintIndex first, end;
  };
  const std::vector<Loop>& loops() const { return loops_; }
  const SimTK::MobilizedBody& body(int body) const { return matter_.getMobilizedBody(bodies_[body]); }

  // The state must be realised to its velocities.
  void read(const SimTK::State& state, MutableBodyColumns out) const;

 private:
  void add(const Mobilizer& joint);
  void add_springs();
  void refuse_no_length(const Spring& spring) const;
  void add_loop(int joint);
  void add_constraints(const Joint& joint);
  void set_start(const Mobilizer& joint);

  SimTK::MobilizedBody mobilized(int body);
  SimTK::Transform frame_in(int body, const Mat3& axes_W, const Vec3& origin_W) const;

  Scene scene_;
  static double share_of_motor(const Motor& motor, double t, double dt);

  Loads loads_;
  double from_ = 0, to_ = 0;    // s
  std::vector<double> shares_;  // of the step, in which each timed force, then each motor acts
  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_;
  SimTK::GeneralForceSubsystem forces_;
  SimTK::Force::UniformGravity gravity_;
  std::vector<SimTK::MobilizedBodyIndex> bodies_;  // by body; Ground for a fixed one
  std::vector<bool> is_free_;                      // by body: hangs on nothing
  std::vector<Loop> loops_;
  SimTK::State start_;

  friend class StageLoads;
};

}  // namespace rigor::inline adapters
