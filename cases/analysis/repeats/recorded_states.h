// All states of a run, to compare bit by bit, and their hashes, to compare on another machine.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/engine/engine.h"

namespace rigor::inline analysis {

// Thirteen columns of each body, step by step, the state at t = 0 first. After a blow-up each NaN is the same one: its
// sign depends on the order of operands and says nothing.
struct RecordedStates {
  static constexpr std::size_t kColumns = 13;

  std::size_t bodies = 0;
  std::vector<double> values;

  std::size_t samples() const { return bodies == 0 ? 0 : values.size() / (kColumns * bodies); }
  const double* body(std::size_t sample, std::size_t i) const {
    return values.data() + kColumns * (sample * bodies + i);
  }
  void add(const World& world);
  // The same states with bodies in another order: body i of the result is body places[i] of this.
  RecordedStates ordered(const std::vector<std::size_t>& places) const;
};

RecordedStates recorded(const Engine& engine, const Settings& settings, const Scene& scene, double dt, long steps);

// The first difference of two recordings, in bits. Lengths that differ are a difference, too.
struct BitDifference {
  long step = 0;
  std::size_t body = 0;
  int column = 0;                  // of kColumnNames
  double there = 0;                // of that number
  double position = 0, angle = 0;  // m, rad: the largest of a body at the end
  double rounding = 0;             // of the number that differs first
  double far_rounding = 0;         // m: of the largest coordinate in the run
};
std::optional<BitDifference> first_difference(const RecordedStates& due, const RecordedStates& found);

// m, rad: the largest differences of a body's pose in one sample.
struct PoseDistance {
  double position = 0, angle = 0;
};
PoseDistance pose_distance(const RecordedStates& x, const RecordedStates& y, std::size_t sample);

// One number for each step, the state at t = 0 first. Equal bits give equal numbers; a single bit changes it.
std::vector<std::uint64_t> hashes_of(const RecordedStates& states);

}  // namespace rigor::inline analysis
