// An engine that is another process, which speaks JSON lines (README.md of this folder).
#pragma once

#include <memory>

#include "adapters/plugin/process_world.h"
#include "core/engine/engine.h"

namespace rigor::inline adapters {

class ProcessEngine : public Engine {
 public:
  // Starts the command once to get its description. Throws InputError, in one sentence, on failure.
  explicit ProcessEngine(PluginStart start);
  // An engine with a known description: nothing is started before its first world.
  ProcessEngine(PluginStart start, PluginInfo info);
  ~ProcessEngine() override;

  EngineInfo info() const override { return info_.engine; }
  const PluginInfo& plugin_info() const { return info_; }
  // Throws EngineFailure. The process is started with the first world, and serves all that come after it.
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override;
  std::string twin(const Settings&) const override { return ""; }
  bool is_remote() const override { return true; }
  void rest() const override;

 protected:
  // What an engine with a known description gets beside the scene, and what its worlds report.
  virtual WorldTerms terms_of(const Scene&, const Settings&) const;

 private:
  PluginStart start_;
  PluginInfo info_;
  bool is_known_ = false;                            // the description was given, and is not the process's
  mutable std::shared_ptr<ProcessSession> session_;  // none until it is needed
};

}  // namespace rigor::inline adapters
