// An engine that does what its script says: body k stands at (n, 0, 0) after n steps, unless told otherwise. For what
// the runner must survive and no real engine does on demand.
#pragma once

#include <functional>

#include "core/engine/clock.h"
#include "core/engine/engine.h"

namespace rigor::test {

struct Script {
  std::function<void(int step, MutableBodyColumns bodies)> play = [](int, MutableBodyColumns) {};
  std::function<std::string(int step)> solver_warning = [](int) { return std::string(); };
};

class ScriptedWorld : public World {
 public:
  ScriptedWorld(const Script& script, const Scene& scene) : script_(script), bodies_(scene.bodies.size()) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) bodies_.columns().set_orientation(i, Quat::Identity());
    script_.play(0, bodies_.columns());
  }
  void step(double dt) override {
    clock_.advance(dt);
    ++steps_;
    for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_.columns().set_position(i, Vec3(steps_, 0, 0));
    script_.play(steps_, bodies_.columns());
  }
  void read(Snapshot& out) const override {
    out.time = clock_.time();
    out.borrow(bodies_.columns());
  }
  SettingsInForce settings_in_force() const override { return {{"scripted", "yes"}}; }
  std::string solver_warning() const override { return script_.solver_warning(steps_); }

 private:
  const Script& script_;
  BodyTable bodies_;
  Clock clock_;
  int steps_ = 0;
};

class ScriptedEngine : public Engine {
 public:
  explicit ScriptedEngine(Script script) : script_(std::move(script)) {}
  EngineInfo info() const override {
    EngineInfo info;
    info.name = "scripted";
    return info;
  }
  std::string twin(const Settings&) const override { return ""; }
  std::unique_ptr<World> load(const Scene& scene, const Settings&) const override {
    return std::make_unique<ScriptedWorld>(script_, scene);
  }

 private:
  Script script_;
};

}  // namespace rigor::test
