// An engine of the table under another name, which changes each scene that it loads: a planted difference.
#pragma once

#include <functional>
#include <string>

#include "adapters/engines.h"
#include "core/engine/engine.h"

namespace rigor::test {

class ChangedEngine : public Engine {
 public:
  ChangedEngine(std::string of, std::function<void(Scene&)> change) : of_(std::move(of)), change_(std::move(change)) {}
  EngineInfo info() const override {
    EngineInfo info = engines().info_of(of_);
    info.name = "changed", info.is_in_house = false;
    return info;
  }
  std::string twin(const Settings&) const override { return ""; }
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override {
    Scene changed = scene;
    if (change_) change_(changed);
    return engines().find(of_).load(changed, settings);
  }

 private:
  std::string of_;
  std::function<void(Scene&)> change_;
};

}  // namespace rigor::test
