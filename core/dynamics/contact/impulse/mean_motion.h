// How bodies in contact move if the integrator moves bodies by the velocities of before the step. Then the loads of a
// step move a body only in the next one. But the impulses of contact cancel these loads within the step, and so would
// push a body that rests by h² g / 2 in each. A body that rocks on its rim would gain the energy of these pushes. A
// body with impulses therefore moves by the mean of its velocities before and after the step.
#pragma once

#include <vector>

#include "core/base/math.h"
#include "core/dynamics/integrators/integrator.h"

namespace rigor::inline dynamics {

// Moves a body by `distance` [m] and turns it by `angle` [rad, about an axis in W].
void displace(std::size_t body, const Vec3& distance, const Vec3& angle, MutableBodyColumns state);

class MeanMotion {
 public:
  explicit MeanMotion(const Integrator& integrator) : is_needed_(integrator.leapfrog_stagger < 0) {}
  bool is_needed() const { return is_needed_; }
  // Before and after the integrator has moved the bodies freely.
  void begin(BodyColumns state);
  void end(BodyColumns state);
  // Of a body that impulses push: `h` [s] times the change of its velocity by the loads of this step.
  void apply(std::size_t body, double h, MutableBodyColumns state) const;

 private:
  struct Change {
    Vec3 v, w;  // m/s, rad/s
  };
  bool is_needed_;
  std::vector<Change> changes_;
};

}  // namespace rigor::inline dynamics
