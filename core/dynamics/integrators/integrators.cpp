#include <algorithm>
#include <cassert>

#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/joints/joints.h"

namespace rigor::inline dynamics {

ConstraintForces* StepperParts::constraints() const { return contact_forces ? contact_forces : joints; }

extern const Integrator kAdams, kDormandPrince, kExplicitEuler, kExponentialAdams, kImplicitMidpoint,
    kLinearlyImplicitEuler, kMoserVeselov, kRk4, kRkmk4, kSemiImplicitEuler, kSymplectic4, kSymplectic8,
    kVelocityVerlet;

const std::vector<Integrator>& integrators() {
  static const std::vector<Integrator> table = {
      kAdams,          kDormandPrince, kExplicitEuler, kExponentialAdams,  kImplicitMidpoint, kLinearlyImplicitEuler,
      kMoserVeselov,   kRk4,           kRkmk4,         kSemiImplicitEuler, kSymplectic4,      kSymplectic8,
      kVelocityVerlet,
  };
  return table;
}

const Integrator& integrator(const std::string& name) {
  const auto& table = integrators();
  const auto row = std::find_if(table.begin(), table.end(), [&](const auto& r) { return r.name == name; });
  assert(row != table.end() && "methods are checked when the run is named");
  return *row;
}

}  // namespace rigor::inline dynamics
