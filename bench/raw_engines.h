// Engines called directly, as a separate program would, with the settings of their adapters. The seam is compared with
// these.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace rigor::bench {

class RawWorld {
 public:
  virtual ~RawWorld() = default;
  // `steps` steps, after each of which thirteen doubles a body are read, body after body.
  virtual void run(int steps, double dt, std::vector<double>& out) = 0;
};

// Free bodies alone: no shapes, springs or forces.
struct RawEngine {
  std::string name, method;  // of the run behind the seam that does the same
  std::unique_ptr<RawWorld> (*make)(const Scene& scene);
};

const std::vector<RawEngine>& raw_engines();  // alphabetical; those that the build has

}  // namespace rigor::bench
