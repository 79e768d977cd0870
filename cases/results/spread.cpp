#include "cases/results/spread.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "core/engine/simulation.h"

namespace rigor::inline results {
namespace {

Quat orientation_in(const std::array<double, 7>& pose) { return {pose[3], pose[4], pose[5], pose[6]}; }

void compare(const Path& a, std::size_t at_a, const Path& b, std::size_t at_b, Spread& spread) {
  const double time = a.times[at_a];
  for (std::size_t i = 0; i < a.bodies; ++i) {
    const auto &one = a.poses[at_a * a.bodies + i], &other = b.poses[at_b * b.bodies + i];
    const double distance = (Vec3(one.data()) - Vec3(other.data())).norm();
    const double angle = angle_between(orientation_in(one), orientation_in(other));
    const int body = static_cast<int>(i);
    if (distance > spread.distance.value) spread.distance = {distance, time, body};
    if (angle > spread.angle.value) spread.angle = {angle, time, body};
    if (!spread.parted_at && (distance > kPartedBy || angle > kPartedByTurn)) spread.parted_at = time;
  }
  spread.compared_until = time;
}

}  // namespace

Path path_of(const Trajectory& trajectory, double duration, std::size_t bodies) {
  Path path;
  path.bodies = bodies;
  const double bytes = static_cast<double>(sizeof(double) + bodies * sizeof(path.poses[0]));
  const double steps = static_cast<double>(steps_in(duration, trajectory.dt));
  const long every = static_cast<long>(std::floor(steps * bytes / kLargestPath)) + 1;
  for (const Sample& sample : trajectory.samples) {
    if (std::lround(sample.time / trajectory.dt) % every != 0) continue;
    path.times.push_back(sample.time);
    for (std::size_t i = 0; i < bodies; ++i) {
      auto& pose = path.poses.emplace_back();
      for (int c = 0; c < 7; ++c) pose[c] = sample.bodies.columns().column(c)[i];
    }
  }
  return path;
}

std::string packed(const Path& path) {
  const std::uint64_t counts[] = {path.bodies, path.times.size()};
  const auto bytes_of = [](const auto& vector) { return vector.size() * sizeof(vector[0]); };
  std::string bytes(reinterpret_cast<const char*>(counts), sizeof counts);
  bytes.append(reinterpret_cast<const char*>(path.times.data()), bytes_of(path.times));
  return bytes.append(reinterpret_cast<const char*>(path.poses.data()), bytes_of(path.poses));
}

Path unpacked(const std::string& bytes) {
  std::uint64_t counts[2];
  Path path;
  const auto refuse = [] { throw std::runtime_error("the bytes of a path are not whole"); };
  if (bytes.size() < sizeof counts) refuse();
  std::memcpy(counts, bytes.data(), sizeof counts);
  const std::size_t left = bytes.size() - sizeof counts;
  // Divided rather than multiplied: a garbled count may be any number.
  if (counts[1] > left / sizeof(double)) refuse();
  const std::size_t of_times = counts[1] * sizeof(double), of_poses = left - of_times;
  if (counts[1] > 0 && counts[0] > of_poses / sizeof(path.poses[0]) / counts[1]) refuse();
  path.bodies = counts[0];
  path.times.resize(counts[1]), path.poses.resize(counts[0] * counts[1]);
  if (path.poses.size() * sizeof(path.poses[0]) != of_poses) refuse();
  if (of_times > 0) std::memcpy(path.times.data(), bytes.data() + sizeof counts, of_times);
  if (of_poses > 0) std::memcpy(path.poses.data(), bytes.data() + sizeof counts + of_times, of_poses);
  return path;
}

Spread spread_between(const Path& a, const Path& b) {
  Spread spread;
  for (std::size_t i = 0, j = 0; i < a.times.size() && j < b.times.size();) {
    const double apart = a.times[i] - b.times[j];
    const double same = 1e-9 * std::max(1.0, a.times[i]);  // s: roundings of a sum of steps, far below any dt
    if (std::abs(apart) <= same) {
      compare(a, i++, b, j++, spread);
    } else {
      ++(apart < 0 ? i : j);
    }
  }
  return spread;
}

}  // namespace rigor::inline results
