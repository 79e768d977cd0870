// The bodies that the truth brings to a stop, and how far each went: ground of stop_distance_error and
// friction_anisotropy.
#pragma once

#include <string>
#include <vector>

#include "cases/metrics/metric.h"

namespace rigor::inline metric {

struct Stop {
  int body;
  double found, expected;  // m, from the start to the run's last sample
  double time;             // s, of that sample
};

// Bodies that move in truth and rest in truth at the last sample. `why_none`: the reason if there are none.
std::vector<Stop> stops_of(const JudgedRun& run, std::string& why_none);

}  // namespace rigor::inline metric
