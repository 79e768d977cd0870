// A scene as ODE's own objects: a dBody for each body that moves, a dGeom for each that collides, a dJoint for each
// joint.
#pragma once

#include <ode/ode.h>

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "adapters/common/external_loads.h"
#include "adapters/ode/ode_joints.h"
#include "adapters/ode/ode_polyhedra.h"
#include "core/engine/clock.h"
#include "core/engine/saved_bytes.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline adapters {

// The direct solver's time grows as the cube of the contacts: a pile of 216 balls takes it over a second a step. The
// method `auto` leaves scenes of more than so many moving bodies that can touch to the sweeps.
inline constexpr int kMostForWorldStep = 50;

class OdeWorld : public World, public ReportsReactions, public ReportsContacts, public ArchivesState {
 public:
  OdeWorld(const Scene& scene, const Settings& settings);
  ~OdeWorld() override;
  OdeWorld(const OdeWorld&) = delete;
  OdeWorld& operator=(const OdeWorld&) = delete;

  void step(double dt) override;
  void read(Snapshot& out) const override;
  SettingsInForce settings_in_force() const override;
  std::string solver_warning() const override { return solver_warning_; }
  Capabilities capabilities() override { return {.reactions = this, .contacts = this, .state = this}; }
  void ask_for_reactions() override { joints_->ask_for_reactions(); }
  std::vector<ReportedReaction> reactions() const override;
  void ask_for_contacts() override { reports_contacts_ = true; }
  std::vector<ReportedContact> contacts() const override;

 private:
  void archive_state(StateArchive& archive) override;
  static void archive_body(StateArchive& archive, dBodyID body);
  void archive_order(StateArchive& archive);
  void apply(const Settings& settings, const Scene& scene);
  void add_body(const Body& body, const Settings& settings);
  void add_geometry(const Body& body, dBodyID moving);
  void add_part(const Body& body, const Shape& shape, const BodyPose& pose, dBodyID moving);
  void advance(double dt);
  void set_cfm(double cfm);
  bool runs_away() const;
  int quick_step(double dt);  // 0 if it could not
  std::string erp_in_words() const;
  std::string cfm_in_words() const;
  std::string solver_in_words() const;
  void add_loads(double dt);
  static double bounce_threshold();  // m/s, of the contacts that are made
  void find_contacts();
  static void touch(void* self, dGeomID a, dGeomID b);  // ODE calls it for each pair whose bounding boxes overlap
  void add_contacts(dGeomID a, dGeomID b);
  void note_contact(dJointID joint, const dContactGeom& found);

  std::vector<dBodyID> bodies_;      // null for a fixed body
  std::vector<BodyState> standing_;  // where a fixed body stands, by body index
  ContactLaws laws_;
  ExternalLoads loads_;
  bool can_touch_;
  double contact_erp_ = 0;
  double step_ = 0;            // s, of the step in progress
  double softness_ = 0;        // 1/kg: cfm/dt where it is set by the masses; 0 where cfm is as shipped or as asked for
  double softness_share_ = 0;  // of the heaviest body's 1/mass
  bool matched_, by_size_, quick_;
  bool lost_ = false;  // blown up: from then on its state is "not a number"
  Clock clock_;
  std::string solver_warning_;
  unsigned long random_seed_ = 0;  // ODE's own at its start

  dWorldID world_;
  OdePolyhedra polyhedra_;
  dSpaceID moving_, fixed_;     // two spaces: fixed shapes are never tried against each other
  std::vector<dGeomID> geoms_;  // in `moving_`, as they were made
  dJointGroupID contacts_;      // lives for one step
  struct Reported {
    ReportedContact contact;  // without its force
    bool a_moves, b_moves;
    dJointFeedback feedback;  // ODE writes it in the step
  };
  bool reports_contacts_ = false;
  std::deque<Reported> reported_;  // of the last step; a deque, because ODE holds pointers into it
  std::optional<OdeJoints> joints_;
};

}  // namespace rigor::inline adapters
