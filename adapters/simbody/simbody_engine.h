// Simbody, double precision. Bodies move in the coordinates of their joints. Joints that close a loop are constraints:
// the accelerations of each stage satisfy them, and each step ends with a projection (Sherman, Seth, Delp, "Simbody:
// multibody dynamics for biomedical research", 2011). No contacts: see README.md.
#pragma once

#include "core/engine/engine.h"

namespace rigor::inline adapters {

class SimbodyEngine : public Engine {
 public:
  EngineInfo info() const override;
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override;
  std::string twin(const Settings& settings) const override;
};

}  // namespace rigor::inline adapters
