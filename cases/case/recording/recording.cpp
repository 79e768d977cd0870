#include "cases/case/recording/recording.h"

#include <algorithm>

#include "core/base/eigen_of.h"
#include "core/base/rotation_vector.h"

namespace rigor::inline cases {
namespace {

// The coefficients of a + b t + c t², which fits the values best. The first column is a, the second b.
Eigen::Matrix3d parabola(const std::vector<double>& times, const std::vector<Vec3>& values, int count) {
  Eigen::MatrixXd powers(count, 3), rows(count, 3);
  for (int i = 0; i < count; ++i) {
    const double t = times[static_cast<std::size_t>(i)];
    powers.row(i) << 1, t, t * t;
    rows.row(i) = values[static_cast<std::size_t>(i)].transpose();
  }
  return least_squares(powers, rows).transpose();
}

void start_by_fit(const RecordedBody& from, int count, Body& body) {
  count = std::min(count, static_cast<int>(from.times.size()));
  if (!from.positions.empty()) {
    const Eigen::Matrix3d path = parabola(from.times, from.positions, count);
    body.position = path.col(0), body.velocity = path.col(1);
  }
  if (from.orientations.empty()) return;
  std::vector<Vec3> turns;  // from the first sample on, in W
  for (int i = 0; i < count; ++i)
    turns.push_back(
        rotation_vector_of(from.orientations[static_cast<std::size_t>(i)] * from.orientations.front().conjugate()));
  const Eigen::Matrix3d turn = parabola(from.times, turns, count);
  body.orientation = (rotation_by(turn.col(0)) * from.orientations.front()).normalized();
  body.angular_velocity = left_jacobian(turn.col(0)) * turn.col(1);
}

}  // namespace

double MotionRecording::longest() const {
  double longest = 0;
  for (const RecordedTrial& trial : trials) longest = std::max(longest, trial.duration);
  return longest;
}

void start_from(const MotionRecording& recording, std::size_t trial, Scene& scene) {
  for (const RecordedBody& from : recording.trials.at(trial).bodies) {
    Body& body = scene.bodies[static_cast<std::size_t>(from.body)];
    if (recording.start_fit > 0) {
      start_by_fit(from, recording.start_fit, body);
      continue;
    }
    if (!from.positions.empty()) body.position = from.positions.front();
    if (!from.orientations.empty()) body.orientation = from.orientations.front();
    if (!from.velocities.empty()) body.velocity = from.velocities.front();
    if (!from.angular_velocities.empty()) body.angular_velocity = from.angular_velocities.front();
  }
}

}  // namespace rigor::inline cases
