// A scene in MuJoCo: springs as its tendons, joints in its trees of bodies, the loops they close as its equalities.
#pragma once

#include <string>

#include "adapters/external_loads.h"
#include "adapters/mujoco/mujoco_model.h"
#include "core/engine/clock.h"

namespace rigor {

class MujocoWorld : public World {
 public:
  MujocoWorld(const Scene& scene, const Settings& settings);

  void step(double dt) override;
  void read(Snapshot& out) const override;
  SettingsInForce settings_in_force() const override;
  std::string solver_warning() const override { return solver_warning_; }

 private:
  void apply_loads(double dt);
  void look_for_warnings();
  void read_free(MutableBodyColumns out, std::size_t body) const;
  void read_jointed(MutableBodyColumns out, std::size_t body) const;

  Scene scene_;  // without its springs and joint springs, which MuJoCo has itself
  SpanningTree tree_;
  MujocoModel made_;
  mujoco_library::Data data_;
  ExternalLoads loads_;  // timed forces
  std::vector<Motor> motors_;
  bool matched_;
  bool is_jointed_;
  double loops_dt_ = 0;  // s: the step that the loops' stiffness is set for
  bool lost_ = false;    // blown up: from then on its state is "not a number"
  Clock clock_;
  std::string solver_warning_;
};

}  // namespace rigor
