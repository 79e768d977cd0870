// A recorded run: one table of bodies for each sampled instant, t = 0 first.
#pragma once

#include <vector>

#include "core/engine/body_table.h"

namespace rigor {

struct Sample {
  double time;  // s
  BodyTable bodies;
};

struct Trajectory {
  double dt = 0;  // s, the step size (samples may be several steps apart)
  std::vector<Sample> samples;
};

}  // namespace rigor
