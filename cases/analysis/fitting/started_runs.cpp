#include "cases/analysis/fitting/started_runs.h"

#include <algorithm>

#include "cases/case/recording/recording.h"

namespace rigor::inline analysis {
namespace {

// Those of a body that moves: shift and speed of a measured position, turn and its rate of a measured orientation.
long unknowns_of(const RecordedBody& body, const Scene& scene) {
  if (scene.bodies[static_cast<std::size_t>(body.body)].fixed) return 0;
  return (body.positions.empty() ? 0 : 6) + (body.orientations.empty() ? 0 : 6);
}

}  // namespace

StartedRuns::StartedRuns(FitProbe& probe, FitTrials trials, std::size_t values)
    : probe_(probe), trials_(std::move(trials)), values_(values), first_{static_cast<long>(values)} {
  for (const FitTrial& one : trials_) {
    long count = 0;
    for (const RecordedBody& body : probe_.recorded(one).bodies)
      count += unknowns_of(body, probe_.scene_of(one.of_case));
    first_.push_back(first_.back() + count);
  }
}

std::optional<BoxPoint> StartedRuns::fit_starts(const BoxPoint& from) {
  constexpr int kMostSteps = 6;  // the recorded starts are nearly right, so a few steps are enough
  const auto values = static_cast<long>(values_);
  Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(first_.back());
  for (std::size_t i = 0; i < values_; ++i) unknowns[static_cast<long>(i)] = from[i];
  LeastSquares method([this](const auto& points) { return residuals_from(points); }, values, unknowns.size());
  const SquaresMinimum found = method.minimise(unknowns, -1, kMostSteps);
  if (!found.has_result()) return {};
  starts_ = found.at.tail(unknowns.size() - values);
  differentiate_by_starts(found);
  return BoxPoint(found.at.data(), found.at.data() + values_);
}

// To both sides, over moves that change the residuals by a standard deviation.
void StartedRuns::differentiate_by_starts(const SquaresMinimum& at) {
  constexpr double kMostMove = 10;  // standard deviations of the noise
  const auto values = static_cast<long>(values_), starts = at.at.size() - values;
  std::vector<Eigen::VectorXd> points;
  Eigen::VectorXd moves(starts);
  for (long j = 0; j < starts; ++j) {
    moves[j] = std::min(1 / std::max(at.jacobian.col(values + j).norm(), 1e-9), kMostMove);
    for (const double side : {1.0, -1.0}) {
      points.push_back(at.at);
      points.back()[values + j] += side * moves[j];
    }
  }
  by_starts_ = by_starts_error_ = Eigen::MatrixXd::Zero(at.residuals.size(), starts);
  const std::vector<Eigen::VectorXd> found = residuals_from(points);
  const Eigen::VectorXd middle = residuals_from({at.at}).front();
  if (middle.size() == 0) return;
  for (long j = 0; j < starts; ++j) {
    const Eigen::VectorXd &up = found[static_cast<std::size_t>(2 * j)],
                          &down = found[static_cast<std::size_t>(2 * j + 1)];
    if (up.size() == 0 || down.size() == 0) continue;
    by_starts_.col(j) = (up - down) / (2 * moves[j]);
    by_starts_error_.col(j) = (up - 2 * middle + down) / (2 * moves[j]);
  }
}

std::vector<Eigen::VectorXd> StartedRuns::residuals(const std::vector<Eigen::VectorXd>& values) {
  std::vector<Eigen::VectorXd> unknowns;
  for (const Eigen::VectorXd& one : values) {
    unknowns.emplace_back(first_.back());
    unknowns.back() << one, starts_;
  }
  return residuals_from(unknowns);
}

// One unit of a start moves the trial's start or its end by about one standard deviation of the noise.
StartedTrial StartedRuns::run_of(const Eigen::VectorXd& unknowns, std::size_t trial) const {
  StartedTrial run{BoxPoint(unknowns.data(), unknowns.data() + values_), trials_[trial], {}};
  const MotionRecording& recording = *probe_.recording_of(run.trial.of_case);
  const RecordedTrial& recorded = probe_.recorded(run.trial);
  long at = first_[trial];
  const auto next = [&](double unit) -> Vec3 {
    at += 3;
    return unit * unknowns.segment<3>(at - 3);
  };
  for (const RecordedBody& body : recorded.bodies) {
    StartShift& shift = run.shifts.emplace_back();
    if (unknowns_of(body, probe_.scene_of(run.trial.of_case)) == 0) continue;
    if (!body.positions.empty()) {
      shift.position = next(recording.position_noise);
      shift.velocity = next(recording.position_noise / recorded.duration);
    }
    if (!body.orientations.empty()) {
      shift.turn = next(recording.orientation_noise);
      shift.angular_velocity = next(recording.orientation_noise / recorded.duration);
    }
  }
  return run;
}

std::vector<Eigen::VectorXd> StartedRuns::residuals_from(const std::vector<Eigen::VectorXd>& points) {
  std::map<std::vector<double>, TrialResiduals> known;
  std::vector<std::vector<std::vector<double>>> keys;
  std::vector<StartedTrial> runs;
  std::vector<std::vector<double>> asked;
  for (const Eigen::VectorXd& point : points) {
    keys.emplace_back();
    for (std::size_t t = 0; t < trials_.size(); ++t) {
      std::vector<double> key{static_cast<double>(t)};
      key.insert(key.end(), point.data(), point.data() + values_);
      key.insert(key.end(), point.data() + first_[t], point.data() + first_[t + 1]);
      keys.back().push_back(key);
      if (known.contains(key)) continue;
      const auto kept = kept_.find(key);
      known[key] = kept == kept_.end() ? TrialResiduals() : kept->second;
      if (kept == kept_.end()) runs.push_back(run_of(point, t)), asked.push_back(key);
    }
  }
  if (!runs.empty()) {
    std::vector<TrialResiduals> found = probe_.residuals(runs);
    for (std::size_t n = 0; n < runs.size(); ++n) known[asked[n]] = std::move(found[n]);
  }
  std::vector<Eigen::VectorXd> all;
  for (const auto& of_point : keys) {
    std::vector<double> positions, rotations;
    bool has_result = true;
    for (const auto& key : of_point) {
      const TrialResiduals& one = known[key];
      has_result &= one.has_result;
      positions.insert(positions.end(), one.positions.begin(), one.positions.end());
      rotations.insert(rotations.end(), one.rotations.begin(), one.rotations.end());
    }
    if (has_result) positions_ = positions.size();
    positions.insert(positions.end(), rotations.begin(), rotations.end());
    all.push_back(has_result ? Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(positions.data(),
                                                                                 static_cast<long>(positions.size())))
                             : Eigen::VectorXd());
  }
  kept_ = std::move(known);
  return all;
}

std::vector<int> StartedRuns::kinds() const {
  std::vector<int> kinds(static_cast<std::size_t>(by_starts_.rows()), 1);
  std::fill_n(kinds.begin(), positions_, 0);
  return kinds;
}

}  // namespace rigor::inline analysis
