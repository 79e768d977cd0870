// The effect of limits and motors of given speed on a joint's coordinate x between two events. There the motion is
// smooth, with the same rows and the same efforts.
#pragma once

#include <cstddef>
#include <vector>

namespace rigor::inline truth {

struct AxisMode {
  int limit = 0;             // x is kept at its lower (-1) or upper (1) one
  int push = 0;              // its motor pushes x up (1) or down (-1) with all it has
  bool keeps_speed = false;  // its motor keeps x' = speed
  int saturated = 0;         // its servo gives all that it may, up (1) or down (-1)
  double speed = 0;          // rad/s, m/s: what its motor asks for
  double most = 0;           // N m, N
  long double bounce = 0;    // rad/s, m/s: that an impact at hand is to leave at the limit

  bool has_row() const { return limit != 0 || keeps_speed; }
};

// One mode per axis (joint_axis.h); if empty, all are free.
using AxisModes = std::vector<AxisMode>;

// Plain numbers for storage; an impact is not included.
inline constexpr std::size_t kNumbersPerMode = 6;

inline std::vector<double> numbers_of(const AxisModes& modes) {
  std::vector<double> numbers;
  for (const AxisMode& mode : modes) {
    for (const double number : {double(mode.limit), double(mode.push), double(mode.keeps_speed), mode.speed, mode.most,
                                double(mode.saturated)})
      numbers.push_back(number);
  }
  return numbers;
}

inline AxisModes modes_of(const double* numbers, std::size_t axes) {
  AxisModes modes(axes);
  for (AxisMode& mode : modes) {
    mode.limit = static_cast<int>(numbers[0]), mode.push = static_cast<int>(numbers[1]);
    mode.keeps_speed = numbers[2] != 0, mode.speed = numbers[3], mode.most = numbers[4];
    mode.saturated = static_cast<int>(numbers[5]);
    numbers += kNumbersPerMode;
  }
  return modes;
}

}  // namespace rigor::inline truth
