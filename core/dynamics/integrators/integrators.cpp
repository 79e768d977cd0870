#include <algorithm>
#include <cassert>

#include "core/dynamics/integrators/integrator.h"

namespace rigor {

extern const Integrator kBulletTwin, kExplicitEuler, kImplicitMidpoint, kOdeTwin, kRk4, kSemiImplicitEuler,
    kVelocityVerlet;

const std::vector<Integrator>& integrators() {
  static const std::vector<Integrator> table = {
      kBulletTwin, kExplicitEuler, kImplicitMidpoint, kOdeTwin, kRk4, kSemiImplicitEuler, kVelocityVerlet,
  };
  return table;
}

const Integrator& integrator(const std::string& name) {
  const auto& table = integrators();
  const auto row = std::find_if(table.begin(), table.end(), [&](const auto& r) { return r.name == name; });
  assert(row != table.end() && "methods are checked when the run is named");
  return *row;
}

}  // namespace rigor
