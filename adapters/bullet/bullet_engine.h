// Bullet, double precision. A semi-implicit step: velocities first (forces, gyroscopic term, contacts and friction by
// sequential impulses), then positions with the new velocities.
#pragma once

#include "core/engine/engine.h"

namespace rigor::inline adapters {

class BulletEngine : public Engine {
 public:
  EngineInfo info() const override;
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override;
  std::string twin(const Settings& settings) const override;
};

}  // namespace rigor::inline adapters
