// ODE, Bullet and Simbody as a program of their own would call them, set as their adapters set them: what the seam is held to.
#pragma once

#include <memory>
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
std::unique_ptr<RawWorld> raw_ode(const Scene& scene);
std::unique_ptr<RawWorld> raw_bullet(const Scene& scene);
std::unique_ptr<RawWorld> raw_simbody(const Scene& scene);  // where the build has Simbody

}  // namespace rigor::bench
