// The outcomes of many starts close to each other, of the run and of the reference: the final places of the moving
// bodies.
#pragma once

#include <string>

#include "cases/metrics/measures/energy_distance.h"

namespace rigor::inline metric {

struct Ensembles {
  EnergyTest test;
  std::string flaw;  // why there is no test; empty if there is
};

}  // namespace rigor::inline metric
