// The description that rigor-siconos gives as its answer to `info`. The main program knows it without starting the
// process.
#pragma once

#include <fmt/format.h>

#include <string>

#include "adapters/siconos/siconos_matched.h"

namespace rigor::inline adapters {

inline std::string siconos_info() {
  return fmt::format(R"({{"ok": true, "rigor": 1, "name": "siconos", "version": "4.4.0",
  "precision": "double", "calls": ["run", "contacts"], "columns": "f64le",
  "features": ["spring", "timed-force", "fixed-body", "restitution", "contact-filter", "friction:none", "friction:coulomb",
    "contact:box-box", "contact:box-capsule", "contact:box-plane", "contact:box-sphere", "contact:capsule-capsule",
    "contact:capsule-plane", "contact:capsule-sphere", "contact:plane-sphere", "contact:sphere-sphere",
    "contact:box-convex", "contact:capsule-convex", "contact:convex-convex", "contact:convex-plane", "contact:convex-sphere",
    "contact:cylinder-plane", "contact:cylinder-sphere", "contact:ellipsoid-plane", "contact:ellipsoid-sphere",
    "contact:box-cylinder", "contact:capsule-cylinder", "contact:convex-cylinder", "contact:cylinder-cylinder",
    "contact:box-ellipsoid", "contact:capsule-ellipsoid", "contact:convex-ellipsoid", "contact:cylinder-ellipsoid",
    "contact:ellipsoid-ellipsoid", "placed-shapes",
    "joint:ball", "joint:fixed", "joint:hinge", "joint:slider", "joint-spring", "joint-damper", "motor:effort",
    "joints-with-contacts", "joints-with-dampers"],
  "methods": [{{"name": "moreau-jean", "summary": "Moreau and Jean's theta method, Coulomb's cone by Gauss-Seidel",
    "order": 2, "options": [
    {{"name": "theta", "meaning": "weight of the step's end", "default": {}, "min": 0.5, "max": 1}},
    {{"name": "tolerance", "meaning": "of the contact solver", "default": {},
      "stock_default": "as shipped", "min": 1e-15, "max": 1}},
    {{"name": "iterations", "meaning": "most of the contact solver", "default": {},
      "stock_default": "as shipped", "min": 1, "max": 1000000, "whole": true}}]}}]}})",
                     kSiconosTheta, kSiconosTolerance, kSiconosIterations);
}

}  // namespace rigor::inline adapters
