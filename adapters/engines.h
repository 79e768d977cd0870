// The table of engines: every simulator that Rigor can run.
#pragma once

#include <memory>
#include <vector>

#include "core/engine/engine.h"
#include "core/engine/run_name.h"

namespace rigor::inline adapters {

// Asks each engine for its facts once, when it is added.
class EngineTable {
 public:
  // Throws InputError for a name that is there already. `identity`: of an engine that is not part of this program, what
  // tells one version of it from another.
  void add(std::unique_ptr<Engine> engine, std::string identity = "");

  const std::vector<EngineInfo>& infos() const { return infos_; }
  const EngineInfo& info_of(const std::string& name) const;       // the name must be there
  const Engine& find(const std::string& name) const;              // likewise
  const std::string& identity_of(const std::string& name) const;  // likewise; empty for one of this program
  // Ends what engines have started outside this process; they start it again when they are next asked for a world.
  void rest() const;
  auto begin() const { return engines_.begin(); }
  auto end() const { return engines_.end(); }

 private:
  std::size_t index_of(const std::string& name) const;

  std::vector<std::unique_ptr<Engine>> engines_;
  std::vector<EngineInfo> infos_;  // of the engines, in their order
  std::vector<std::string> identities_;
};

// An engine that Rigor knows, and that this build was made without or that is not installed.
struct MissingEngine {
  std::string name;
  std::string how;  // "not built: install libdart-dev and build again"
};
const std::vector<MissingEngine>& missing_engines();  // alphabetical

// Engines of this program that take part where they are named, and not by default.
struct EngineOnRequest {
  std::string name;
  std::string why;
  std::string formulas_of = {};  // another engine: where both agree, that is no second opinion
};
const std::vector<EngineOnRequest>& engines_on_request();  // alphabetical, built or not
bool is_on_request(const std::string& engine);
// The engine whose formulas this one has, which is most often itself.
std::string formulas_of(const std::string& engine);

EngineTable built_in_engines();  // alphabetical; a copy of one's own, to add others to
const EngineTable& engines();    // the same, without additional engines

// A run's settings as the calls that its adapter makes for them, to paste into a program. `world` and `body` are called
// as in the engine's tutorials; the last line is the step, of `dt` as written. None for an engine without calls.
std::vector<std::string> engine_calls(const RunName& run, const std::string& dt);

inline const std::vector<EngineInfo>& infos_of(const EngineTable& table) { return table.infos(); }
inline const Engine& find_engine(const EngineTable& table, const std::string& name) { return table.find(name); }

}  // namespace rigor::inline adapters
