// The rows of the table of engines that are here without their library: the core repeats their published schemes
// (adapters/README.md, "Scheme replicas").
#include "adapters/bullet/bullet_twin.h"
#include "adapters/common/engine_row.h"
#include "adapters/ode/ode_twin.h"

namespace rigor::inline adapters {
namespace {

std::unique_ptr<Engine> no_engine() { return nullptr; }

}  // namespace

EngineRow bullet_row() {
  return {.make = no_engine, .twins = [] { return std::vector<Integrator>{kBulletTwin}; }};
}
EngineRow ode_row() {
  return {.make = no_engine, .twins = [] { return std::vector<Integrator>{kOdeTwin}; }};
}

}  // namespace rigor::inline adapters
