// What a run makes of many starts close to each other, beside what the reference makes of others: the places in which
// the bodies that move end.
#pragma once

#include <string>

#include "cases/metrics/measures/energy_distance.h"

namespace rigor {

struct Ensembles {
  EnergyTest test;
  std::string flaw;  // why there is no test; empty if there is
};

}  // namespace rigor
