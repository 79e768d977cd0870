#include "cases/analysis/repeats/recorded_states.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace rigor::inline analysis {

void RecordedStates::add(const World& world) {
  thread_local Snapshot now;  // read at each step: it keeps its memory
  world.read(now);
  bodies = now.bodies().size();
  const std::size_t start = values.size();
  values.resize(start + kColumns * bodies);
  for (std::size_t c = 0; c < kColumns; ++c) {
    const double* column = now.bodies().column(static_cast<int>(c));
    double* to = values.data() + start + c;
    for (std::size_t i = 0; i < bodies; ++i)
      to[kColumns * i] = std::isnan(column[i]) ? std::numeric_limits<double>::quiet_NaN() : column[i];
  }
}

RecordedStates RecordedStates::ordered(const std::vector<std::size_t>& places) const {
  RecordedStates out;
  out.bodies = places.size();
  out.values.reserve(samples() * kColumns * places.size());
  for (std::size_t n = 0; n < samples(); ++n) {
    for (const std::size_t place : places)
      out.values.insert(out.values.end(), body(n, place), body(n, place) + kColumns);
  }
  return out;
}

RecordedStates recorded(const Engine& engine, const Settings& settings, const Scene& scene, double dt, long steps) {
  const auto world = engine.load(scene, settings);
  expect_steps(*world, dt, steps, 1);
  RecordedStates states;
  states.values.reserve(RecordedStates::kColumns * scene.bodies.size() * static_cast<std::size_t>(steps + 1));
  states.add(*world);
  for (long n = 0; n < steps; ++n) world->step(dt), states.add(*world);
  return states;
}

PoseDistance pose_distance(const RecordedStates& x, const RecordedStates& y, std::size_t sample) {
  PoseDistance most;
  for (std::size_t i = 0; i < x.bodies; ++i) {
    const double *a = x.body(sample, i), *b = y.body(sample, i);
    const double far = (Vec3(a[0], a[1], a[2]) - Vec3(b[0], b[1], b[2])).norm();
    const double turned =
        angle_between(Quat(a[3], a[4], a[5], a[6]).normalized(), Quat(b[3], b[4], b[5], b[6]).normalized());
    // Numbers that are not finite are an infinite distance.
    most.position = std::max(most.position, std::isfinite(far) ? far : HUGE_VAL);
    most.angle = std::max(most.angle, std::isfinite(turned) ? turned : HUGE_VAL);
  }
  return most;
}

std::optional<BitDifference> first_difference(const RecordedStates& due, const RecordedStates& found) {
  const std::size_t common = std::min(due.values.size(), found.values.size());
  std::size_t at = 0;
  while (at < common && std::bit_cast<std::uint64_t>(due.values[at]) == std::bit_cast<std::uint64_t>(found.values[at]))
    ++at;
  if (at == common && due.values.size() == found.values.size()) return {};
  BitDifference difference;
  if (due.bodies == 0 || found.bodies != due.bodies) return difference;
  const std::size_t row = RecordedStates::kColumns * due.bodies;
  difference.step = static_cast<long>(at / row);
  difference.body = at % row / RecordedStates::kColumns;
  difference.column = static_cast<int>(at % RecordedStates::kColumns);
  if (at < common) difference.there = std::abs(due.values[at] - found.values[at]);
  const std::size_t samples = std::min(due.samples(), found.samples());
  const PoseDistance end = pose_distance(due, found, samples - 1);
  difference.position = end.position, difference.angle = end.angle;
  constexpr double kEpsilon = 0x1p-52;
  if (at < common) difference.rounding = kEpsilon * std::abs(due.values[at]);
  for (std::size_t i = 0; i < due.bodies; ++i) {
    for (int c = 0; c < 3; ++c)
      difference.far_rounding = std::max(difference.far_rounding, kEpsilon * std::abs(due.body(samples - 1, i)[c]));
  }
  return difference;
}

// Multiply and shift, a number at a time: a bijection of the hash for a given number, and of the number for a given
// hash.
static std::uint64_t mixed(std::uint64_t hash, std::uint64_t number) {
  constexpr std::uint64_t kFactor = 0xff51afd7ed558ccd;
  hash = (hash ^ number) * kFactor;
  return hash ^ (hash >> 32);
}

// Four hashes of every fourth number, which the processor makes at once, and the hash of these. No single change is
// lost.
std::vector<std::uint64_t> hashes_of(const RecordedStates& states) {
  constexpr std::uint64_t kStart = 0x9e3779b97f4a7c15;
  constexpr std::size_t kParts = 4;
  std::vector<std::uint64_t> hashes;
  hashes.reserve(states.samples());
  const std::size_t row = RecordedStates::kColumns * states.bodies;
  for (std::size_t n = 0; n < states.samples(); ++n) {
    const double* values = states.values.data() + n * row;
    const auto bits = [&](std::size_t k) { return std::bit_cast<std::uint64_t>(values[k]); };
    std::uint64_t parts[kParts] = {kStart, kStart, kStart, kStart};
    std::size_t k = 0;
    for (; k + kParts <= row; k += kParts) {
      for (std::size_t part = 0; part < kParts; ++part) parts[part] = mixed(parts[part], bits(k + part));
    }
    for (; k < row; ++k) parts[k % kParts] = mixed(parts[k % kParts], bits(k));
    std::uint64_t hash = kStart;
    for (const std::uint64_t part : parts) hash = mixed(hash, part);
    hashes.push_back(hash);
  }
  return hashes;
}

}  // namespace rigor::inline analysis
