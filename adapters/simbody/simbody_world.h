// A scene in Simbody, stepped by one of its integrators. This header shows nothing of Simbody's own, whose headers are
// C++17.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/engine/engine.h"

namespace rigor::inline adapters {

std::string simbody_version();

// How an integrator is told to step. What is not there it is not told.
struct SimbodySteps {
  bool are_fixed;                              // each of dt; otherwise as its estimate of its error asks, within dt
  std::optional<double> accuracy;              // relative to the state's scale
  std::optional<double> constraint_tolerance;  // m, or sine of an angle
  bool reads_between;                          // steps past the end, and interpolates back
};
SimbodySteps simbody_steps(const Settings& settings);
// The option of an adaptive method.
OptionInfo simbody_accuracy(const std::string& method);

std::unique_ptr<World> simbody_world(const Scene& scene, const Settings& settings);

}  // namespace rigor::inline adapters
