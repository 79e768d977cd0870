#include "core/dynamics/contact/impulse/impact_energy.h"

#include <algorithm>
#include <cmath>

#include "core/dynamics/kernels/kernels.h"

namespace rigor {

double ImpactEnergy::product(BodyColumns state, const AlignedDoubles& a, const AlignedDoubles& b) const {
  double sum = 0;
  for (std::size_t i = 0; i < system_.size(); ++i) {
    const Inertia& body = system_.bodies[i];
    if (body.fixed) continue;
    const Eigen::Map<const Vec3> v(a.data() + kRecord * i), w(a.data() + kRecord * i + 3);
    const Eigen::Map<const Vec3> v_of_b(b.data() + kRecord * i), w_of_b(b.data() + kRecord * i + 3);
    sum += body.mass * v.dot(v_of_b) + w.dot(angular_momentum_of(body, state.rotation(i), w_of_b));
  }
  return sum;
}

void ImpactEnergy::limit(BodyColumns state, AlignedDoubles& velocities) {
  if (product(state, velocities, velocities) <= before_) return;
  change_ = velocities;
  for (std::size_t k = 0; k < change_.size(); ++k) change_[k] -= without_[k];
  // c + 2 b s + a s² = before_, in [0, 1].
  const double a = product(state, change_, change_), b = product(state, without_, change_),
               c = product(state, without_, without_) - before_;
  double share = 0;
  if (c < 0) share = -c / (b + std::sqrt(b * b - a * c));
  share = std::clamp(share, 0.0, 1.0);
  for (std::size_t k = 0; k < velocities.size(); ++k) velocities[k] = without_[k] + share * change_[k];
}

}  // namespace rigor
