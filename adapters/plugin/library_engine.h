// An engine that is a shared library, in this process.
#pragma once

#include <memory>
#include <string>

#include "adapters/plugin/plugin_info.h"
#include "core/engine/engine.h"

namespace rigor::inline adapters {

class LibraryEngine : public Engine {
 public:
  // Asks for the library's description in a child process. Throws InputError, in one sentence, on failure. `limit`: s.
  LibraryEngine(std::string path, double limit);

  EngineInfo info() const override { return info_.engine; }
  const PluginInfo& plugin_info() const { return info_; }
  // Throws EngineFailure. The library is loaded with the first world, into the process that asks for it.
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override;
  std::string twin(const Settings&) const override { return ""; }

 private:
  std::string path_;
  PluginInfo info_;
};

}  // namespace rigor::inline adapters
