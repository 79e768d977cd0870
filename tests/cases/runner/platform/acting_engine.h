// An engine whose cells do what a simulated process can do: answer, wait, hang, die.
#pragma once

#include <fmt/format.h>

#include <csignal>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "core/base/error.h"
#include "core/engine/engine.h"
#include "core/engine/engine_failure.h"
#include "tests/cases/runner/platform/simulated_platform.h"

namespace rigor::test {

// What a cell's engine does.
enum class Way { good, waits, computes, aborts, exits, hangs, spins, diverges, dies, throws, refuses };
inline constexpr int kWays = 11;

inline constexpr double kLimit = 0.25;  // s; short, since the pool looks after its children every 50 ms

// Hears of each cell that begins; the schedule that is played.
class CellStage {
 public:
  virtual ~CellStage() = default;
  virtual void begins(const std::string& cell) = 0;
  virtual SimulatedPlatform& platform() = 0;
};
inline CellStage* cell_stage = nullptr;

inline std::string name_of(const std::string& engine, const std::string& of_case, double dt) {
  return fmt::format("{} {} {:g}", of_case, engine, dt);
}

using Ways = std::map<std::string, Way>;  // by cell

// Often one whose result is short, since most of a schedule's time goes to reading results.
inline Way draw_way(Dice& dice) {
  const double drawn = dice.unit();
  return drawn < 0.12 ? Way::good : drawn < 0.76 ? Way::diverges : static_cast<Way>(dice.below(kWays));
}

class ActingEngine : public Engine {
 public:
  ActingEngine(std::string name, const Ways& ways) : name_(std::move(name)), ways_(ways) {}
  EngineInfo info() const override {
    EngineInfo info;
    info.name = name_, info.version = "0", info.precision = "double";
    info.methods.push_back({"only", "acts", 1, false, 0, {}});
    return info;
  }
  std::string twin(const Settings&) const override { return ""; }
  std::unique_ptr<World> load(const Scene& scene, const Settings&) const override {
    return std::make_unique<ActingWorld>(*this, scene);
  }

 private:
  class ActingWorld : public World {
   public:
    ActingWorld(const ActingEngine& engine, const Scene& scene) : engine_(engine), body_(scene.bodies.front()) {}
    void step(double dt) override {
      time_ += dt;
      // Each cell has its own motion.
      body_.position.x() += dt * (1 + 0.125 * dt) * static_cast<double>(engine_.name_.size() + body_.name.back() % 7);
      if (++steps_ == 1) cell_stage->begins(name_of(engine_.name_, body_.name, dt));
      if (steps_ == 2) act(engine_.ways_.at(name_of(engine_.name_, body_.name, dt)), body_.position.x());
    }
    void read(Snapshot& out) const override {
      out.own(1).set_body(0, {body_.position, body_.orientation, body_.velocity, body_.angular_velocity});
      out.time = time_;
    }
    SettingsInForce settings_in_force() const override { return {{"name", engine_.name_}}; }
    std::string solver_warning() const override { return ""; }

   private:
    static void act(Way way, double x) {
      SimulatedPlatform& platform = cell_stage->platform();
      platform.breathe();
      if (way == Way::waits) platform.sleep(std::chrono::milliseconds(2000));  // eight tenths of what it may
      if (way == Way::computes) platform.spend(0.8 * kLimit);
      if (way == Way::aborts) platform.die_of(SIGABRT);
      if (way == Way::exits) platform.exit_now(3);
      if (way == Way::hangs) platform.hang();
      if (way == Way::spins) platform.spend(1e9);
      if (way == Way::diverges) throw EngineFailure(FailureKind::diverged, "it diverged by " + std::to_string(x));
      if (way == Way::dies) throw EngineFailure(FailureKind::crashed, "it died");
      if (way == Way::throws) throw std::runtime_error("out of luck");
      if (way == Way::refuses) throw InputError("no such thing");
    }
    const ActingEngine& engine_;
    Body body_;
    double time_ = 0;
    int steps_ = 0;
  };

  std::string name_;
  const Ways& ways_;
};

}  // namespace rigor::test
