// When and where two runs of one scene leave a bound.
#pragma once

#include <optional>
#include <string>

#include "cases/analysis/divergence/motion_view.h"
#include "cases/analysis/divergence/parting_bounds.h"

namespace rigor::inline analysis {

// B's state less A's; all in W.
struct BodyGap {
  Vec3 position = Vec3::Zero();          // m
  Vec3 turn = Vec3::Zero();              // rad: the rotation vector that takes A's orientation to B's
  Vec3 velocity = Vec3::Zero();          // m/s
  Vec3 angular_velocity = Vec3::Zero();  // rad/s

  // The gap after free motion for some seconds.
  BodyGap carried(double seconds) const;
  BodyGap& operator+=(const BodyGap& other);
  BodyGap operator*(double factor) const;
};
BodyGap gap_between(const BodyState& a, const BodyState& b);

// The largest share of a bound.
double share_of(const BodyGap& gap, const PartingBounds& bounds);

struct Parting {
  double time = 0;  // s
  std::size_t sample = 0;
  int body = 0;
  std::string component;             // "py"; of an orientation "turn about y"
  std::string unit;                  // of the gap and the bound
  double gap = 0, bound = 0;         // of the quantity as a whole, in SI
  double part = 0;                   // of the gap along the component, with its sign: B less A
  std::optional<double> in_a, in_b;  // the component in both runs; none for an orientation
};

// The largest share of a bound in one sample, or in the samples of both up to `last`; with its sample.
struct LargestShare {
  double share = 0;
  std::size_t sample = 0;
  int body = 0;
};
LargestShare share_at(const MotionView& a, const MotionView& b, const Scene& scene, const PartingBounds& bounds,
                      std::size_t sample);
LargestShare largest_share(const MotionView& a, const MotionView& b, const Scene& scene, const PartingBounds& bounds,
                           std::size_t last);

// The first sample at which a moving body leaves the bound, by more than three times `spread`; the body that is then
// the farthest. `spread`: for each sample the share by which repeats of one run differ; empty for none.
std::optional<Parting> find_parting(const MotionView& a, const MotionView& b, const Scene& scene,
                                    const PartingBounds& bounds, double seconds_per_sample,
                                    const std::vector<double>& spread);

}  // namespace rigor::inline analysis
