// A scene in MuJoCo: springs as its tendons, joints in its trees of bodies, the loops they close as its equalities.
#pragma once

#include <string>

#include "adapters/common/external_loads.h"
#include "adapters/mujoco/mujoco_model.h"
#include "adapters/mujoco/mujoco_reactions.h"
#include "core/engine/saved_bytes.h"

namespace rigor::inline adapters {

class MujocoWorld : public World, public ReportsReactions, public ReportsContacts, public ArchivesState {
 public:
  MujocoWorld(const Scene& scene, const Settings& settings);

  void step(double dt) override;
  void read(Snapshot& out) const override;
  SettingsInForce settings_in_force() const override;
  std::string solver_warning() const override { return solver_warning_; }
  // MuJoCo keeps only the forces of the last stage of RK4. They are no mean over the step.
  Capabilities capabilities() override {
    return {.reactions = this, .contacts = made_.model->opt.integrator == mjINT_RK4 ? nullptr : this, .state = this};
  }
  void ask_for_reactions() override { is_asked_ = said_.are_said(); }
  std::vector<ReportedReaction> reactions() const override;
  void ask_for_contacts() override {}  // MuJoCo always keeps them
  std::vector<ReportedContact> contacts() const override;

 private:
  void archive_state(StateArchive& archive) override;
  void apply_loads(double dt);
  void look_for_warnings();
  void note_reactions() const;
  void read_free(MutableBodyColumns out, std::size_t body) const;
  void read_jointed(MutableBodyColumns out, std::size_t body) const;

  Scene scene_;  // without its springs and joint springs, which MuJoCo has itself
  SpanningTree tree_;
  MujocoModel made_;
  mujoco_library::Data data_;
  ExternalLoads loads_;                 // timed forces
  std::vector<Motor> motors_, servos_;  // that give an effort; that are MuJoCo's own
  bool has_servos_;
  bool matched_;
  bool is_jointed_;
  double stiff_dt_ = 0;  // s: the step that the stiffness of loops and limits is set for
  bool lost_ = false;    // blown up: from then on its state is "not a number"
  MujocoReactions said_;
  bool is_asked_ = false;
  std::vector<int> body_of_geom_;         // of the scene
  mutable bool is_step_in_data_ = false;  // not yet computed for the new positions
  mutable std::vector<ReportedReaction> reactions_;
  Clock clock_;
  std::string solver_warning_;
};

}  // namespace rigor::inline adapters
