// DART 6, double precision. Joints are coordinates of trees of bodies (Featherstone's articulated-body algorithm);
// contacts, limits and the joints that close loops are a boxed LCP in velocities (Lee et al., "DART: Dynamic Animation
// and Robotics Toolkit", 2018).
#pragma once

#include "core/engine/engine.h"

namespace rigor::inline adapters {

class DartEngine : public Engine {
 public:
  EngineInfo info() const override;
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override;
  std::string twin(const Settings& settings) const override;
};

}  // namespace rigor::inline adapters
