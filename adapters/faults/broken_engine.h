// An engine that does everything as another does it, but for one thing. Its world is made anew from the state before
// every step where the fault needs that; whether that alone trips a gate, the tests ask first.
#pragma once

#include <memory>
#include <string>

#include "adapters/faults/fault.h"
#include "core/engine/engine.h"

namespace rigor::inline adapters {

class BrokenEngine : public Engine {
 public:
  BrokenEngine(const Engine& engine, Fault fault) : engine_(engine), fault_(std::move(fault)) {}
  EngineInfo info() const override { return engine_.info(); }
  std::string twin(const Settings& settings) const override { return engine_.twin(settings); }
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override;

 private:
  const Engine& engine_;
  Fault fault_;
};

}  // namespace rigor::inline adapters
