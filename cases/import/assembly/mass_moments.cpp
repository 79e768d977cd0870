#include "cases/import/assembly/mass_moments.h"

#include <cmath>
#include <limits>

#include "core/base/eigen_of.h"
#include "core/scene/validate.h"

namespace rigor::inline imports {
namespace {

// Least second moment of the repaired tensor, as a share of their sum. A plate or a needle has less, but thinner ones
// than 1 to 30 are no links of robots, and their stiff motion would hide the rest.
constexpr double kLeastMoment = 1e-3;

// The principal moments nearest to `moments` that matter can have. They are sums of two second moments s of the mass,
// and each s is at least `least`. The least squares of each set of s that stay at that bound are tried in turn.
std::optional<Vec3> nearest_moments(const Vec3& moments, double least) {
  std::optional<Vec3> best;
  double distance = std::numeric_limits<double>::infinity();
  Mat3 sums;
  sums << 0, 1, 1, 1, 0, 1, 1, 1, 0;
  for (int bound = 0; bound < 8; ++bound) {
    Eigen::MatrixXd free(3, 0);
    for (int i = 0; i < 3; ++i) {
      if (bound & (1 << i)) continue;
      free.conservativeResize(3, free.cols() + 1);
      free.col(free.cols() - 1) = sums.col(i);
    }
    Vec3 s = Vec3::Constant(least);
    if (free.cols() > 0) {
      Vec3 rest = moments;
      for (int i = 0; i < 3; ++i) {
        if (bound & (1 << i)) rest -= least * sums.col(i);
      }
      const Eigen::VectorXd found = (free.transpose() * free).ldlt().solve(free.transpose() * rest);
      for (int i = 0, k = 0; i < 3; ++i) {
        if (!(bound & (1 << i))) s[i] = found[k++];
      }
    }
    const Vec3 reached = sums * s;
    if (s.minCoeff() < least || (reached - moments).norm() >= distance) continue;
    best = reached, distance = (reached - moments).norm();
  }
  return best;
}

}  // namespace

Mat3 steiner(double mass, const Vec3& offset) {
  return mass * (offset.squaredNorm() * Mat3::Identity() - offset * offset.transpose());
}

std::optional<RepairedInertia> nearest_inertia(const Mat3& inertia) {
  const double size = inertia.norm();
  if (!(size > 0)) return {};
  const SymmetricEigen principal = eigen_of(inertia);
  const Vec3 given(principal.values[0], principal.values[1], principal.values[2]);
  const double sum = given.cwiseAbs().sum() / 2;
  const auto moments = nearest_moments(given, kLeastMoment * sum);
  if (!moments) return {};
  const Mat3 repaired = principal.vectors * moments->asDiagonal() * principal.vectors.transpose();
  const Mat3 symmetric = (repaired + repaired.transpose()) / 2;
  if (!why_no_inertia(symmetric).empty()) return {};
  return RepairedInertia{symmetric, (symmetric - inertia).norm() / size};
}

}  // namespace rigor::inline imports
