// The distance between two runs of a case. Each cell leaves a path: its bodies' positions at instants that all runs of
// one dt share. The instants are few, so that the paths of a whole case fit into memory.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "cases/case/case.h"
#include "core/engine/trajectory.h"

namespace rigor::inline results {

struct Path {
  std::size_t bodies = 0;
  std::vector<double> times;                 // s
  std::vector<std::array<double, 7>> poses;  // m and quaternion (w, x, y, z); all bodies of the first instant, then on
};

// Every step, or every n-th where that would pass kLargestPath bytes. `duration`: of the case, however soon the run
// ended.
inline constexpr double kLargestPath = 512e3;
Path path_of(const Trajectory& trajectory, double duration, std::size_t bodies);

std::string packed(const Path& path);     // bytes, for a pipe between processes of one program
Path unpacked(const std::string& bytes);  // throws std::runtime_error for bytes that are no path

// Two runs have parted once a body of one is further than this from the same body of the other.
inline constexpr double kPartedBy = 1e-3;      // m
inline constexpr double kPartedByTurn = 1e-2;  // rad

struct Furthest {
  double value = 0;  // m or rad
  double time = 0;   // s
  int body = 0;
};

struct Spread {
  std::size_t first = 0, second = 0;  // indices in Results::runs
  StepSize dt{0, ""};
  Furthest distance, angle;
  std::optional<double> parted_at;  // s; none if they stayed together
  double compared_until = 0;        // s: the end of the shorter one

  // Of a run with itself at its finest step, and not of two runs at one.
  bool is_own_step() const { return first == second; }
};

// Over the instants that both have. The runs and dt are left for the caller to fill in.
Spread spread_between(const Path& a, const Path& b);

}  // namespace rigor::inline results
