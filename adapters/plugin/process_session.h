// The conversation with a process plug-in: its requests, written and read to the letter of the protocol.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "adapters/plugin/answer.h"
#include "adapters/plugin/child_process.h"
#include "adapters/plugin/plugin_info.h"
#include "core/base/json_fwd.h"

namespace rigor::inline adapters {

// How a plug-in is started.
struct PluginStart {
  std::string command;
  double limit;  // s, see ChildProcess
  int log;       // see ChildProcess
};

class ProcessSession {
 public:
  // Starts the command and performs the handshake. Throws InputError for an invalid description, EngineFailure without
  // an answer.
  explicit ProcessSession(const PluginStart& start);

  const PluginInfo& info() const { return info_; }
  // Takes a fuller description than the process gave.
  void describe(PluginInfo info) { info_ = std::move(info); }
  const ChildProcess& child() const { return *child_; }
  bool is_usable() const { return is_sound_ && child_->is_ours(); }

  // Each throws EngineFailure; after one that is not `unsupported` or `diverged` no other request makes sense.
  // Returns the number of a new world. `beside`: further keys of the request, each with a comma in front.
  int load(const Scene& scene, const Settings& settings, const std::string& beside, SettingsInForce& in_force);
  void step(int world, double dt, const std::vector<double>& wrenches);  // none: no wrenches
  void read(int world, double due, double dt, MutableBodyColumns into);
  // `count` steps, of which each `every`-th, and the last, is sampled into one of the tables; `begin`: s.
  void run(int world, double begin, double dt, long count, long every, std::vector<KeptBodies>& samples);
  std::vector<ReportedContact> contacts(int world);  // of its last step
  // Of its last step, for each joint. The first request comes before the first step, and asks for reports.
  std::vector<ReportedReaction> reactions(int world, std::size_t joints, std::size_t bodies);
  std::string save(int world);  // what the engine makes of its state
  void restore(int world, const std::string& snapshot);
  void unload(int world);
  // The engine's message about its last step or run: why it is less accurate than the method promises.
  const std::string& warning() const { return warning_; }

 private:
  Json ask(const std::string& line, const std::string& call, std::size_t longest, int world = 0);
  // Reads an answer's parts; where that fails the conversation is out of step.
  template <typename Read>
  void checked(const Read& read);
  void keep_warning(const Json& answer);
  void receive_raw(const Question& asked, std::size_t bodies);
  void copy_raw(const Question& asked, std::size_t n, MutableBodyColumns into) const;

  PluginInfo info_;
  std::unique_ptr<ChildProcess> child_;
  std::string warning_;
  bool is_sound_ = true;
  int worlds_ = 0;
  std::vector<double> raw_;
};

}  // namespace rigor::inline adapters
