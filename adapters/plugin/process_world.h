// A world of a process plug-in: one request a step and a read, or one for many steps where it is known that they come.
#pragma once

#include <memory>
#include <optional>

#include "adapters/plugin/process_session.h"
#include "adapters/plugin/rigor_loads.h"
#include "core/engine/saved_bytes.h"

namespace rigor::inline adapters {

// What one world of an engine gets and reports, beyond the engine's description.
struct WorldTerms {
  std::string beside_scene;  // further keys of the request to load it, each with a comma in front
  bool has_contacts, has_reactions;
};

class ProcessWorld : public World,
                     public RemoteRuns,
                     public ReportsContacts,
                     public ReportsReactions,
                     public SavesState {
 public:
  ProcessWorld(std::shared_ptr<ProcessSession> session, const Scene& scene, const Settings& settings, WorldTerms terms);
  ~ProcessWorld() override;

  void step(double dt) override;
  void read(Snapshot& out) const override;
  SettingsInForce settings_in_force() const override { return in_force_; }
  std::string solver_warning() const override { return lost_why_.empty() ? warning_ : lost_why_; }
  Capabilities capabilities() override {
    return {.remote = this,
            .reactions = terms_.has_reactions ? this : nullptr,
            .contacts = terms_.has_contacts ? this : nullptr,
            .state = session_->info().has_state && loads_.empty() ? this : nullptr};
  }
  std::unique_ptr<SavedState> save() const override;
  void restore(const SavedState& state) override;
  // A run of many steps reports the last of them alone, so each step is its own request from now on.
  void ask_for_contacts() override { asks_for_reports_ = true, ahead_ = {}; }
  std::vector<ReportedContact> contacts() const override;
  void ask_for_reactions() override;
  std::vector<ReportedReaction> reactions() const override;
  void expect(double dt, long steps, long every) override;
  double remote_cpu_seconds() const override {
    return session_->child().cpu_seconds() - session_->child().looked_for();
  }

 private:
  // Announced steps, and how many of them the engine has already taken.
  struct Ahead {
    double dt = 0;
    long left = 0, every = 1;   // announced steps that were not yet requested
    long count = 0, taken = 0;  // of the last request, and how many of its steps have been handed out
    std::vector<KeptBodies> samples;
  };

  void run_ahead();
  void step_alone(double dt);
  void go_back_and_step();
  void lose(const std::string& why, int body) const;  // from now on that body's state is not finite
  void read_now() const;
  std::size_t bodies() const { return scene_.bodies.size(); }

  void archive_state(StateArchive& archive, std::string& snapshot);

  std::shared_ptr<ProcessSession> session_;
  StateOwner owner_;
  const Scene scene_;
  const Settings settings_;
  const WorldTerms terms_;
  RigorLoads loads_;
  SettingsInForce in_force_;
  int world_ = 0;
  Clock clock_;
  double last_dt_ = 0;
  long steps_ = 0;
  bool steps_are_equal_ = true;  // all so far were of last_dt_
  bool asks_for_reports_ = false;
  Ahead ahead_;
  mutable BodyTable state_;
  mutable bool is_read_ = false;  // state_ is current
  std::string warning_;           // of the last request for steps
  mutable std::string lost_why_;  // not empty: the state is no longer finite
};

}  // namespace rigor::inline adapters
