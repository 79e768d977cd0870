#include "cases/case/recording/noise.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "core/base/eigen_of.h"
#include "core/base/rotation_vector.h"

namespace rigor::inline cases {
namespace {

constexpr std::size_t kWindow = 9;  // samples: a parabola through fewer follows the noise, and more meet more impacts
constexpr double kFree = 3 * (kWindow - 3.0);  // of three coordinates, each with a parabola taken off

// The mean square along one axis, of what a parabola leaves of the values.
double left_by_parabola(const double* times, const std::vector<Vec3>& values) {
  Eigen::Matrix<double, kWindow, 3> powers, rows;
  const double middle = times[kWindow / 2], unit = times[kWindow - 1] - times[0];
  for (std::size_t i = 0; i < kWindow; ++i) {
    const double t = (times[i] - middle) / unit;
    powers.row(static_cast<long>(i)) << 1, t, t * t;
    rows.row(static_cast<long>(i)) = (values[i] - values[kWindow / 2]).transpose();
  }
  const Eigen::Matrix3d fitted = least_squares(powers, rows);
  return (rows - powers * fitted).squaredNorm() / kFree;
}

// The standard deviation, from the median of mean squares that are distributed as chi-squared where noise is alone.
std::optional<double> deviation_of(std::vector<double> squares) {
  if (squares.empty()) return {};
  const auto middle = squares.begin() + static_cast<long>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  const double median_of_one = quantile(boost::math::chi_squared(kFree), 0.5) / kFree;
  const double deviation = std::sqrt(*middle / median_of_one);
  constexpr double kRounding = 1e-12;  // m or rad: of numbers with 17 digits, not of a measurement
  return deviation > kRounding ? std::optional(deviation) : std::nullopt;
}

}  // namespace

EstimatedNoise estimated_noise(const std::vector<RecordedTrial>& trials) {
  std::vector<double> positions, turns;
  for (const RecordedTrial& trial : trials) {
    for (const RecordedBody& body : trial.bodies) {
      for (std::size_t first = 0; first + kWindow <= body.times.size(); ++first) {
        const double* times = &body.times[first];
        const auto window = [&](const auto& value_of) {
          std::vector<Vec3> values;
          for (std::size_t i = first; i < first + kWindow; ++i) values.push_back(value_of(i));
          return left_by_parabola(times, values);
        };
        if (!body.positions.empty()) positions.push_back(window([&](std::size_t i) { return body.positions[i]; }));
        if (body.orientations.empty()) continue;
        const Quat middle = body.orientations[first + kWindow / 2].conjugate();
        turns.push_back(window([&](std::size_t i) { return rotation_vector_of(body.orientations[i] * middle); }));
      }
    }
  }
  return {deviation_of(std::move(positions)), deviation_of(std::move(turns))};
}

}  // namespace rigor::inline cases
