// The contact forces of one run for the page: for each pair of bodies their resultant, and where it acts. Engines share
// a resultant among points in different ways, so single points are not comparable and not shown.
#pragma once

#include <utility>
#include <vector>

#include "cases/report/json/packing.h"
#include "core/engine/trajectory.h"

namespace rigor::inline report {

class ForcePlayback {
 public:
  static constexpr std::size_t kMostPairs = 8;

  // Of the pairs with the largest forces.
  explicit ForcePlayback(const Trajectory& trajectory);

  // The size of each pair's force [N] at each sample.
  const std::vector<std::vector<double>>& sizes() const { return sizes_; }

  // u32 pairs; for each: u32 a, u32 b. If there is a pair: f32 lowest x y z, f32 extent x y z of the points; then for
  // each pair, for each of the point's x, y, z, the force's and the normal's, for each sample: u16, over the extent,
  // the upper half of a float32 [N], over -1..1. A pair that does not touch has no force and no normal.
  void add_to(Bytes& bytes, const std::vector<std::size_t>& samples) const;

 private:
  struct Resultant {
    Vec3 point = Vec3::Zero();   // m: the points' mean, weighted with their normal forces
    Vec3 force = Vec3::Zero();   // N on b
    Vec3 normal = Vec3::Zero();  // unit, from a to b: likewise; zero without a force
  };
  Resultant resultant(std::size_t sample, std::pair<int, int> pair) const;  // the pair's lower number first

  const Trajectory& trajectory_;
  std::vector<std::pair<int, int>> pairs_;
  std::vector<std::vector<double>> sizes_;
};

}  // namespace rigor::inline report
