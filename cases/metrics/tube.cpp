// The share of a run's time inside a tube around the truth. At some instant within one dt of now, every body must be
// within its tolerance of the truth: |Δp|²/r² + (Δangle)²/a² <= 1. r is 1 % of the diagonal of the box around the
// body's true path, or at least 1 mm; a is 1 % of half a turn. A run that is correct except for a small lag stays
// inside, while position_error counts its whole distance.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "cases/metrics/measures/measuring.h"
#include "cases/metrics/measures/pose_gap.h"

namespace rigor::inline metric {
namespace {

constexpr double kLeastRadius = 1e-3;               // m
constexpr double kShareOfExtent = 0.01;             // 1
constexpr double kAngle = 0.01 * std::numbers::pi;  // rad

class Tube {
 public:
  Tube(const JudgedRun& run, std::size_t count)
      : run_(run), end_(run.trajectory.samples[count - 1].time), truth_(run.scene.bodies.size()) {
    for (std::size_t i = 0; i < run.scene.bodies.size(); ++i) {
      Eigen::AlignedBox3d box;
      for (std::size_t n = 0; n < count; ++n) box.extend(run.truth->bodies[n].columns().position(i));
      radii_.push_back(std::max(kLeastRadius, kShareOfExtent * box.diagonal().norm()));
    }
  }

  // 1 or less: inside. Its body and gap are those furthest out at the nearest of the instants tried.
  double distance(std::size_t n, Instant& worst) {
    const Sample& sample = run_.trajectory.samples[n];
    const double first = std::max(0.0, sample.time - run_.trajectory.dt);
    const double last = std::min(end_, sample.time + run_.trajectory.dt);
    truth_ = run_.truth->bodies[n].columns();
    double best = furthest(sample, worst), time = sample.time;
    if (best - reach(n) > 1) return best;
    constexpr int kRounds = 4;  // of Gauss and Newton's method: within a dt the path is nearly straight
    for (int round = 0; round < kRounds && best > 1; ++round) {
      const double forward = time_to_nearest(sample);
      if (!std::isfinite(forward)) break;
      const double next = std::clamp(time + forward, first, last);
      if (next == time) break;
      time = next;
      run_.truth->source->at(time, truth_.columns());
      Instant here;
      const double value = furthest(sample, here);
      if (value < best) best = value, worst = here;
    }
    return best;
  }

 private:
  // An upper bound, in tolerances, of how much nearer the truth can come within a dt: at twice its largest speed at the
  // samples there. If that is not enough, the slow evaluation of the truth is skipped.
  double reach(std::size_t n) const {
    constexpr double kMargin = 2;
    double fastest = 0;
    for (std::size_t k = n == 0 ? 0 : n - 1; k <= n + 1 && k < run_.truth->bodies.size(); ++k) {
      const BodyColumns truth = run_.truth->bodies[k].columns();
      for (std::size_t i = 0; i < radii_.size(); ++i) {
        const double moves = truth.velocity(i).norm() / radii_[i], turns = truth.angular_velocity(i).norm() / kAngle;
        fastest = std::max(fastest, std::hypot(moves, turns));
      }
    }
    return kMargin * fastest * run_.trajectory.dt;
  }

  double furthest(const Sample& sample, Instant& worst) const {
    double most = -1;
    for (std::size_t i = 0; i < radii_.size(); ++i) {
      const PoseGap gap = pose_gap(sample.bodies.columns().body(i), truth_.columns().body(i));
      const double moved = gap.position.norm() / radii_[i], turned = gap.orientation.norm() / kAngle;
      const double out = std::hypot(moved, turned);
      if (out <= most) continue;
      most = out;
      worst = {sample.time, static_cast<int>(i), "distance in tolerances", out, 1};
    }
    return most;
  }

  // The step in time, of the truth as it stands, that brings all bodies nearest in the sum of squares.
  double time_to_nearest(const Sample& sample) const {
    double down = 0, bend = 0;
    for (std::size_t i = 0; i < radii_.size(); ++i) {
      const PoseGap gap = pose_gap(sample.bodies.columns().body(i), truth_.columns().body(i));
      const double p = 1 / (radii_[i] * radii_[i]), q = 1 / (kAngle * kAngle);
      down -= p * gap.position.dot(gap.position_rate) + q * gap.orientation.dot(gap.orientation_rate);
      bend += p * gap.position_rate.squaredNorm() + q * gap.orientation_rate.squaredNorm();
    }
    return down / bend;
  }

  const JudgedRun& run_;
  double end_;  // s, the last instant compared
  BodyTable truth_;
  std::vector<double> radii_;  // m, one a body
};

MetricResult measure_tube(const JudgedRun& run) {
  if (!run.truth || !run.truth->source) return {{}, kNoTruth};
  const std::size_t count = samples_within(run, std::min(kTruthNeededPosition, kTruthNeededOrientation));
  if (count == 0) return {{}, kNoSamples};
  Tube tube(run, count);
  // Samples: a share to 1e-4. For jointed bodies, whose truth takes up to a hundred times as long, to 1e-3.
  const std::size_t most = run.scene.joints.empty() ? 10000 : 1000, every = 1 + count / most;
  std::size_t inside = 0, all = 0;
  Measurement out;
  for (std::size_t n = 0; n < count; n += every, ++all) {
    Instant here;
    const bool is_inside = tube.distance(n, here) <= 1;
    if (is_inside ? n == 0 : inside == all) out.worst = here;  // where it first leaves
    inside += is_inside;
  }
  out.value = static_cast<double>(inside) / static_cast<double>(all);
  out.compared_until = run.trajectory.samples[count - 1].time;
  return {out, ""};
}

}  // namespace

MetricRow tube() {
  return {.name = "tube",
          .unit = "1",
          .summary = "share of the time within 1 % of the truth's extent, within one dt; higher is better",
          .measure = measure_tube,
          .higher_is_better = true,
          .is_costly = true};
}

}  // namespace rigor::inline metric
