// What a world can do beside step and read. Each capability is an interface; World::capabilities() returns a pointer to
// each one that the world has. A decorator returns those of the world that it wraps.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace rigor::inline engine {

// A world in another process.
class RemoteRuns {
 public:
  virtual ~RemoteRuns() = default;
  // The next `steps` steps all have length dt. Only every `every`-th of them, and the last, are read, so one request
  // can cover many steps. Any other call before they are done is a bug.
  virtual void expect(double dt, long steps, long every) = 0;
  // CPU seconds that the other process has spent, less those that this one spent in waiting for it.
  virtual double remote_cpu_seconds() const = 0;
};

struct ReducedOrder {
  double from = 0;  // s: the start of the first such step
  std::string how;  // a phrase: "in part by inelastic steps of first order ..."
  bool operator==(const ReducedOrder& other) const { return from == other.from && how == other.how; }
};

// A world that continues by a method of lower order where its own would take too long.
class MayReduceOrder {
 public:
  virtual ~MayReduceOrder() = default;
  // The time from which the run used a lower order; empty if it never did.
  virtual std::optional<ReducedOrder> reduced_order() const = 0;
};

// A world whose method divides each step. The step of its name is then not the step that it takes.
class MayDivideSteps {
 public:
  virtual ~MayDivideSteps() = default;
  // s, of the last step's parts; none if the last step was taken as one.
  virtual std::optional<double> sub_step() const = 0;
};

// The load of a joint on one of its two bodies, as a mean over the last step; in W.
struct ReportedReaction {
  int body = kWorld;           // one that moves; the other bears the opposite, at the joint
  Vec3 force = Vec3::Zero();   // N
  Vec3 torque = Vec3::Zero();  // N m, about the body's centre of mass at the step's start
};

// A world whose engine reports what its joints carry.
class ReportsReactions {
 public:
  virtual ~ReportsReactions() = default;
  // Switches the reports on. They may cost time.
  virtual void ask_for_reactions() = 0;
  // One for each joint of the scene, in its order; none before the first step.
  virtual std::vector<ReportedReaction> reactions() const = 0;
  // Whether the steps from now on are read. An engine may save the work for those that are not.
  virtual void report_reactions(bool) {}
};

// One point at which two bodies touch, or may touch within the step; in W. It belongs to the last step.
struct ReportedContact {
  int a = kWorld, b = kWorld;   // bodies
  Vec3 point = Vec3::Zero();    // m
  Vec3 normal = Vec3::UnitX();  // unit, from a to b
  double gap = 0;               // m; negative if they overlap
  Vec3 force = Vec3::Zero();    // N on b at the point: the impulses of the step divided by its length
};

// A world whose engine reports its contact forces.
class ReportsContacts {
 public:
  virtual ~ReportsContacts() = default;
  // Switches the reports on. They may cost time.
  virtual void ask_for_contacts() = 0;
  // All points of the last step; none before the first step.
  virtual std::vector<ReportedContact> contacts() const = 0;
};

// All that a world's next steps depend on, at one instant: also what its engine keeps beyond the bodies' states. Each
// engine has its own.
class SavedState {
 public:
  virtual ~SavedState() = default;
};

// A world whose state can be saved, and restored at any later time.
class SavesState {
 public:
  virtual ~SavesState() = default;
  virtual std::unique_ptr<SavedState> save() const = 0;
  // `state` was saved by this world, or by another of the same scene and settings.
  virtual void restore(const SavedState& state) = 0;
};

struct Capabilities {
  RemoteRuns* remote = nullptr;
  MayReduceOrder* reduced_order = nullptr;
  MayDivideSteps* divided_steps = nullptr;
  ReportsReactions* reactions = nullptr;
  ReportsContacts* contacts = nullptr;
  SavesState* state = nullptr;
};

}  // namespace rigor::inline engine
