// Random numbers that are the same with every compiler and library.
#pragma once

#include <cmath>
#include <random>

#include "core/base/math.h"

namespace rigor::test {

class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}

  double share() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }  // 0 <= share < 1
  double between(double low, double high) { return low + (high - low) * share(); }
  double log_between(double low, double high) { return low * std::pow(high / low, share()); }
  int below(int count) { return static_cast<int>(count * share()); }
  bool chance(double of) { return share() < of; }
  Vec3 vector(double most) { return {between(-most, most), between(-most, most), between(-most, most)}; }
  Vec3 direction() { return turn() * Vec3::UnitX(); }
  Quat turn() {
    const double z = between(-1, 1), y = between(-1, 1), x = between(-1, 1), w = between(-1, 1);
    return Quat(w, x, y, z).normalized();
  }
  template <typename Row>
  const Row& one_of(const std::vector<Row>& rows) {
    return rows[static_cast<std::size_t>(below(static_cast<int>(rows.size())))];
  }

 private:
  std::mt19937_64 bits_;
};

}  // namespace rigor::test
