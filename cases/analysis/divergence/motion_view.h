// Bodies in the samples of a computed motion (mistakes/motions.h).
#pragma once

#include "cases/analysis/mistakes/motions.h"
#include "core/engine/body_table.h"

namespace rigor::inline analysis {

class MotionView {
 public:
  MotionView(const StateSeries& motion, std::size_t bodies) : states_(&motion.states), bodies_(bodies) {}

  std::size_t bodies() const { return bodies_; }
  std::size_t samples() const { return states_->size() / (kMotionColumns * bodies_); }
  BodyState body(std::size_t sample, std::size_t i) const {
    const double* row = states_->data() + kMotionColumns * (sample * bodies_ + i);
    Mat3 R;
    for (int k = 0; k < 9; ++k) R(k / 3, k % 3) = row[3 + k];
    return {Vec3(row[0], row[1], row[2]), Quat(R).normalized(), Vec3(row[12], row[13], row[14]),
            Vec3(row[15], row[16], row[17])};
  }
  std::vector<BodyState> state(std::size_t sample) const {
    std::vector<BodyState> all;
    for (std::size_t i = 0; i < bodies_; ++i) all.push_back(body(sample, i));
    return all;
  }

 private:
  const std::vector<double>* states_;
  std::size_t bodies_;
};

}  // namespace rigor::inline analysis
