// An engine whose bodies stand still and whose steps do what a test wants.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "adapters/engines.h"
#include "cases/case/case.h"

namespace rigor {

class FaultyEngine : public Engine {
 public:
  using Fault = std::function<void(double& x)>;  // x: the first body's position along x, which goes wrong or not
  FaultyEngine(std::string name, Fault fault, std::string solver_warning = "")
      : name_(std::move(name)), fault_(std::move(fault)), solver_warning_(std::move(solver_warning)) {}

  EngineInfo info() const override {
    EngineInfo info;
    info.name = name_, info.version = "0", info.precision = "double";
    info.is_in_house = name_ == "core";
    info.methods.push_back({"only", "stands still", 1, false, 0, {}});
    return info;
  }

  std::string twin(const Settings&) const override { return ""; }
  std::unique_ptr<World> load(const Scene& scene, const Settings&) const override {
    return std::make_unique<FaultyWorld>(*this, scene);
  }

 private:
  class FaultyWorld : public World {
   public:
    FaultyWorld(const FaultyEngine& engine, const Scene& scene) : engine_(engine), scene_(scene) {}
    void step(double dt) override { time_ += dt, engine_.fault_(scene_.bodies.front().position.x()); }
    void read(Snapshot& out) const override {
      const auto bodies = out.own(scene_.bodies.size());
      for (std::size_t i = 0; i < bodies.size(); ++i) {
        const Body& body = scene_.bodies[i];
        bodies.set_body(i, {body.position, body.orientation, body.velocity, body.angular_velocity});
      }
      out.time = time_;
    }
    SettingsInForce settings_in_force() const override { return {{"fault", engine_.name_}}; }
    std::string solver_warning() const override { return engine_.solver_warning_; }

   private:
    const FaultyEngine& engine_;
    Scene scene_;
    double time_ = 0;
  };

  std::string name_;
  Fault fault_;
  std::string solver_warning_;
};

// One body adrift: a case that every engine of the table above supports.
inline Case drifting_body(const std::string& id) {
  Case definition;
  definition.id = id, definition.title = "One body adrift";
  Body body;
  body.name = "stone";
  body.velocity = Vec3(1, 0, 0);
  definition.scene.bodies.push_back(body);
  definition.duration = 0.5;
  definition.dt = {{0.1, "1/10"}, {0.05, "1/20"}};
  return definition;
}

// Loses its numbers after 20 s, at steps of more than 0.1 s.
class LateEngine : public FaultyEngine {
 public:
  LateEngine() : FaultyEngine("late", [this](double& x) { x = is_lost() ? std::nan("") : 0; }) {}
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override {
    time_ = 0;
    return std::make_unique<LateWorld>(*this, FaultyEngine::load(scene, settings));
  }

 private:
  class LateWorld : public World {
   public:
    LateWorld(const LateEngine& engine, std::unique_ptr<World> world) : engine_(engine), world_(std::move(world)) {}
    void step(double dt) override {
      engine_.dt_ = dt, engine_.time_ += dt;
      world_->step(dt);
    }
    void read(Snapshot& out) const override { world_->read(out); }
    SettingsInForce settings_in_force() const override { return world_->settings_in_force(); }
    std::string solver_warning() const override { return ""; }

   private:
    const LateEngine& engine_;
    std::unique_ptr<World> world_;
  };

  bool is_lost() const { return dt_ > 0.1 && time_ > 20; }
  mutable double dt_ = 0, time_ = 0;  // s
};

}  // namespace rigor
