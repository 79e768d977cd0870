#include "core/dynamics/contact/impulse/rebounds/impact_energy.h"

#include <algorithm>
#include <cmath>

namespace rigor::inline dynamics {
namespace {

// a·M b
double product(const System& system, BodyColumns pose, const std::vector<Vec6>& a, const std::vector<Vec6>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < system.size(); ++i) {
    const Inertia& body = system.bodies[i];
    if (body.fixed) continue;
    const Vec3 L = angular_momentum_of(body, pose.rotation(i), b[i].tail<3>());
    sum += body.mass * a[i].head<3>().dot(b[i].head<3>()) + a[i].tail<3>().dot(L);
  }
  return sum;
}

}  // namespace

double twice_energy_of(const System& system, BodyColumns pose, const std::vector<Vec6>& velocities) {
  return product(system, pose, velocities, velocities);
}

double limit_energy(const System& system, BodyColumns pose, double most, const std::vector<Vec6>& without,
                    std::vector<Vec6>& with) {
  if (twice_energy_of(system, pose, with) <= most) return 1;
  std::vector<Vec6> change = with;
  for (std::size_t i = 0; i < change.size(); ++i) change[i] -= without[i];
  // c + 2 b s + a s² = most, in [0, 1].
  const double a = product(system, pose, change, change), b = product(system, pose, without, change),
               c = product(system, pose, without, without) - most;
  double share = 0;
  if (c < 0) share = -c / (b + std::sqrt(b * b - a * c));
  share = std::clamp(share, 0.0, 1.0);
  for (std::size_t i = 0; i < with.size(); ++i) with[i] = without[i] + share * change[i];
  return share;
}

}  // namespace rigor::inline dynamics
