// The seam between Rigor and a simulator. An adapter implements Engine and World and nothing else; whole scenes are
// converted, nobody exposes an engine's own interface. The in-house core enters by the same door (adapters/core/).
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/engine/body_table.h"
#include "core/engine/capabilities.h"
#include "core/engine/option_info.h"
#include "core/scene/features/features.h"
#include "core/scene/scene.h"

namespace rigor::inline engine {

// `matched` sets the engine to the scene's physics as truly as it can; `stock` leaves every setting as it ships.
enum class Track { matched, stock };

struct MethodInfo {
  std::string name;
  std::string summary;      // one line
  int order = 1;            // the global error falls as dt^order on smooth scenes
  bool symplectic = false;  // on undamped smooth scenes
  bool symmetric = false;   // a step back undoes a step forward, to rounding, on undamped smooth scenes
  // Number of steps by which read velocities lag behind positions: 1/2 for a semi-implicit step, -1/2 for an explicit
  // one. Energy is judged only after velocities are brought to the instant of the positions.
  double leapfrog_stagger = 0;
  // Divides each step until it meets a tolerance. The error does not follow from dt, and `order` is that of the inner
  // steps.
  bool adaptive = false;
  Features lacks = {};  // of the engine's features, those that this method cannot express
  std::vector<OptionInfo> options = {};
  // The engine whose scheme this method repeats to explain that engine's error; "" for an independent method. A twin is
  // an instrument, not a competitor: it runs only where it is named.
  std::string twin_of = "";
};

struct EngineInfo {
  std::string name;
  std::string version;
  std::string precision;                                                   // "double", "single"
  Features features = {};                                                  // that it expresses
  std::vector<std::string> unknown_features = {};                          // words of a plug-in that no Feature has
  std::vector<MethodInfo> methods = {};                                    // the first is the default
  double max_rotation_per_step = std::numeric_limits<double>::infinity();  // rad; beyond it the engine clamps
  // Rigor's own engine: all its methods run by default, and other engines are compared with the best
  bool is_in_house = false;
};

struct Settings {
  std::string method;                          // a name of EngineInfo::methods
  std::map<std::string, std::string> options;  // checked against the method's options before load
  Track track = Track::matched;
};

// Every body at the world's current time. An engine that holds the columns itself lends them; another fills own(). A
// borrowed snapshot is valid until the world's next step.
class Snapshot {
 public:
  double time = 0;  // s
  BodyColumns bodies() const { return bodies_; }

  void borrow(BodyColumns columns) { bodies_ = columns; }
  // Columns to fill, one row a body of the scene, in the scene's order.
  MutableBodyColumns own(std::size_t size, bool has_rotation = false) {
    if (storage_.size() != size || storage_.has_rotation() != has_rotation) storage_.resize(size, has_rotation);
    bodies_ = storage_.columns();
    return storage_.columns();
  }

  Snapshot() = default;
  Snapshot(const Snapshot&) = delete;  // copy the columns into a BodyTable instead
  Snapshot& operator=(const Snapshot&) = delete;

 private:
  BodyTable storage_;
  BodyColumns bodies_;
};

// A setting in force, read back from the engine after loading: ("gyroscopic", "implicit, body frame").
using SettingsInForce = std::vector<std::pair<std::string, std::string>>;

class World {
 public:
  virtual ~World() = default;
  virtual void step(double dt) = 0;            // exactly one step of dt seconds
  virtual void read(Snapshot& out) const = 0;  // every body, at the world's current time
  virtual SettingsInForce settings_in_force() const = 0;
  // Why the last step did not do what its method promises (an iteration that did not converge, say); empty if it did.
  virtual std::string solver_warning() const = 0;
  virtual Capabilities capabilities() { return {}; }
};

// The capabilities of a world, where it has them.
inline void expect_steps(World& world, double dt, long steps, long every) {
  if (RemoteRuns* remote = world.capabilities().remote) remote->expect(dt, steps, every);
}
inline double remote_cpu_seconds(World& world) {
  const RemoteRuns* remote = world.capabilities().remote;
  return remote ? remote->remote_cpu_seconds() : 0;
}
inline std::optional<ReducedOrder> reduced_order_of(World& world) {
  const MayReduceOrder* may = world.capabilities().reduced_order;
  return may ? may->reduced_order() : std::nullopt;
}
inline std::optional<double> sub_step_of(World& world) {
  const auto* divided = world.capabilities().divided_steps;
  return divided ? divided->sub_step() : std::nullopt;
}
inline void ask_for_reactions(World& world) {
  if (ReportsReactions* reports = world.capabilities().reactions) reports->ask_for_reactions();
}
inline std::vector<ReportedReaction> reported_reactions(World& world) {
  const ReportsReactions* reports = world.capabilities().reactions;
  return reports ? reports->reactions() : std::vector<ReportedReaction>();
}
inline void report_reactions(World& world, bool are_read) {
  if (ReportsReactions* reports = world.capabilities().reactions) reports->report_reactions(are_read);
}

// Whether the world will report its contacts from now on.
inline bool ask_for_contacts(World& world) {
  ReportsContacts* reports = world.capabilities().contacts;
  if (reports) reports->ask_for_contacts();
  return reports != nullptr;
}
inline std::vector<ReportedContact> reported_contacts(World& world) {
  const ReportsContacts* reports = world.capabilities().contacts;
  return reports ? reports->contacts() : std::vector<ReportedContact>();
}

class Engine {
 public:
  virtual ~Engine() = default;
  virtual EngineInfo info() const = 0;
  virtual std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const = 0;
  // The name of the core's run that repeats, on smooth scenes, the scheme that this engine publishes for these
  // settings;
  // "" for an engine that is its own scheme.
  virtual std::string twin(const Settings& settings) const = 0;
  // Whether its worlds live in another process (Capabilities::remote).
  virtual bool is_remote() const { return false; }
  // Ends its process if no world uses it. The next load starts it again.
  virtual void rest() const {}
};

// Why this engine cannot run this scene at this dt; empty if it can. The sentence names the feature and what in the
// scene asks for it.
std::string why_unsupported(const EngineInfo& engine, const Scene& scene, double dt);
// The same for the settings of a run. If an option's choices differ in features, the choice in force decides, and the
// sentence names a choice that would work.
std::string why_unsupported(const EngineInfo& engine, const Settings& settings, const Scene& scene, double dt);

}  // namespace rigor::inline engine
