#include "cases/analysis/fitting/profile.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <tuple>

#include "core/base/eigen_of.h"
#include "core/base/error.h"

namespace rigor::inline analysis {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kChiSquaredFall = 3.841458820694124;  // the 95 % quantile of chi-squared with one degree of freedom
constexpr double kNearFall = 0.02;                     // of the fall: an end is then right to 1 % of the half width
constexpr int kMostEndTries = 20;                      // for one end
constexpr double kLeastWidth = 1e-9;                   // of a bracket in the box
constexpr int kMostRestarts = 4;                       // with a better minimum, found on the way
constexpr double kFewestFree = 3;                      // residuals beyond the unknowns, from which noise can be judged
constexpr double kSureOfExcess = 0.999;                // with which a residual is called larger than the noise
constexpr double kRoughNoise = 1.4;  // an estimate from the scatter of some ten windows may be so wrong

void scale_columns(Matrix& all) {
  for (long j = 0; j < all.cols(); ++j)
    if (const double norm = all.col(j).norm(); norm > 0) all.col(j) /= norm;
}

constexpr double kRankThreshold = 1e-6;  // of derivatives by differences

long rank_of(Matrix jacobian) {
  scale_columns(jacobian);
  return basis_of(jacobian, kRankThreshold).cols();
}

// Of all unknowns. A direction that the residuals do not know gets a large variance, and no infinite one.
Matrix covariance_of(const Matrix& jacobian) {
  const long n = jacobian.cols();
  Vector scale(n);
  for (long j = 0; j < n; ++j) scale[j] = std::max(jacobian.col(j).norm(), 1e-150);
  Matrix square = jacobian.transpose() * jacobian;
  square = scale.cwiseInverse().asDiagonal() * square * scale.cwiseInverse().asDiagonal();
  constexpr double kRidge = 1e-12;
  square.diagonal().array() += kRidge;
  const Matrix inverse = square.ldlt().solve(Matrix::Identity(n, n));
  return scale.cwiseInverse().asDiagonal() * inverse * scale.cwiseInverse().asDiagonal();
}

class Profiling {
 public:
  explicit Profiling(const ProfileInput& input)
      : input_(input), values_(input.starts.front().size()), weights_(1 + largest_kind(), 1.0), method_(squares()) {
    span_others();
  }

  Profile run() {
    search();
    Profile profile;
    profile.excess.assign(weights_.size(), 1);
    const auto count = static_cast<double>(best_.residuals.size());
    free_ = count - static_cast<double>(rank_of(best_.jacobian) + span_.cols());
    profile.is_told = free_ >= kFewestFree;
    if (profile.is_told) {
      weigh(profile);
      tell_axes(profile);
    }
    profile.best = best_.at;
    return profile;
  }

 private:
  std::size_t largest_kind() const {
    return static_cast<std::size_t>(*std::max_element(input_.kinds.begin(), input_.kinds.end()));
  }
  std::size_t kind_of(long row) const { return static_cast<std::size_t>(input_.kinds[static_cast<std::size_t>(row)]); }

  // Weighs the residuals, and takes off what the other unknowns can.
  LeastSquares squares() const {
    const auto left = [this](const std::vector<Vector>& points) {
      std::vector<Vector> all = input_.residuals(points);
      for (Vector& one : all) {
        if (one.size() == 0) continue;
        weigh_rows(one);
        one -= span_ * (span_.transpose() * one);
      }
      return all;
    };
    return {left, values_, values_};
  }

  template <typename Rows>
  void weigh_rows(Rows& rows) const {
    for (long row = 0; row < rows.rows(); ++row) rows.row(row) *= weights_[kind_of(row)];
  }

  // Takes the columns one by one, the best known first. The rest that a column adds to those before must be larger than
  // its own error. Contacts that open and close make such errors, and a direction made of errors means nothing.
  void span_others() {
    constexpr double kKnown = 3;  // errors
    Matrix others = input_.others, errors = input_.others_error;
    weigh_rows(others), weigh_rows(errors);
    const Vector least = (kRankThreshold * others.colwise().norm()).transpose();
    const Vector error = errors.colwise().norm().transpose().cwiseMax(least).cwiseMax(1e-300);
    span_.resize(static_cast<long>(input_.kinds.size()), 0);
    for (long n = 0; n < others.cols(); ++n) {
      long at = 0;
      const double ratio = (others.colwise().norm().transpose().array() / error.array()).maxCoeff(&at);
      if (ratio < kKnown) return;
      const Vector direction = others.col(at).normalized();
      span_.conservativeResize(Eigen::NoChange, n + 1);
      span_.col(n) = direction;
      others -= direction * (direction.transpose() * others).eval();
    }
  }

  void search() {
    for (const Vector& start : input_.starts) {
      minima_.push_back(minimum_from(start));
      if (minima_.back().value < best_.value) best_ = minima_.back();
    }
    if (!best_.has_result()) throw InputError("no run at the best values found reaches its end");
  }

  SquaresMinimum minimum_from(const Vector& at, long held = -1) { return method_.minimise(at, held); }

  // What is left of each kind decides where the noise is not known, and where it is larger than the noise.
  void weigh(Profile& profile) {
    for (int round = 0; round < 3; ++round) {
      bool is_changed = false;
      for (std::size_t kind = 0; kind < weights_.size(); ++kind) {
        const double left = left_of(kind);  // in units of the noise
        if (std::isnan(left)) continue;
        const bool is_beyond = input_.is_noise_estimated ? left > kRoughNoise : left > largest_usual(kind);
        if (is_beyond) profile.excess[kind] = left;
        const double weight = input_.is_noise_estimated || is_beyond ? 1 / left : weights_[kind];
        if (std::abs(weight / weights_[kind] - 1) > 0.01) is_changed = true;
        weights_[kind] = weight;
        if (weight != 1) is_scaled_ = true;
      }
      if (!is_changed) break;
      span_others();
      best_ = minimum_from(best_.at);
    }
    profile.wait = wait();
    double fall = kChiSquaredFall;
    if (is_scaled_) fall = std::pow(quantile(boost::math::students_t(free_), 0.975), 2);
    fall_ = fall * profile.wait;
  }

  double share_of_free(std::size_t kind) const {
    return free_ * static_cast<double>(std::count(input_.kinds.begin(), input_.kinds.end(), static_cast<int>(kind))) /
           static_cast<double>(input_.kinds.size());
  }

  double left_of(std::size_t kind) const {
    double sum = 0;
    for (long row = 0; row < best_.residuals.size(); ++row)
      if (kind_of(row) == kind) sum += std::pow(best_.residuals[row] / weights_[kind], 2);
    const double left = std::sqrt(sum / share_of_free(kind));
    constexpr double kNone = 1e-9;  // of the noise: there is no scatter at all
    return left > kNone ? left : NAN;
  }

  double largest_usual(std::size_t kind) const {
    const double free = share_of_free(kind);
    return std::sqrt(quantile(boost::math::chi_squared(free), kSureOfExcess) / free);
  }

  // Residuals that resemble those of the row before tell less than their number. Returns how many tell as much as one.
  double wait() const {
    constexpr long kRow = 3;
    double longest = 1;
    for (std::size_t kind = 0; kind < weights_.size(); ++kind) {
      double both = 0, one = 0, count = 0;
      for (long row = 0; row < best_.residuals.size(); ++row) {
        if (kind_of(row) != kind) continue;
        one += std::pow(best_.residuals[row], 2), ++count;
        if (row >= kRow && kind_of(row - kRow) == kind) both += best_.residuals[row] * best_.residuals[row - kRow];
      }
      constexpr double kSigns = 3.1;  // standard errors, 99.9 % sure
      const double correlation = one > 0 ? std::min(both / one, 0.99) : 0;
      if (correlation > kSigns / std::sqrt(count)) longest = std::max(longest, (1 + correlation) / (1 - correlation));
    }
    return longest;
  }

  void tell_axes(Profile& profile) {
    for (int restart = 0;; ++restart) {
      profile.axes.clear(), is_beaten_ = false;
      covariance_ = covariance_of(best_.jacobian);
      for (long i = 0; i < values_ && !is_beaten_; ++i) profile.axes.push_back(axis_of(i));
      if (!is_beaten_ || restart == kMostRestarts) break;
      best_ = minimum_from(best_.at);
    }
    profile.axes.resize(static_cast<std::size_t>(values_));
    add_other_minima(profile);
    for (long i = 0; i < values_; ++i) {
      profile.correlations.emplace_back();
      for (long j = 0; j < values_; ++j)
        profile.correlations.back().push_back(
            i == j ? 1 : covariance_(i, j) / std::sqrt(covariance_(i, i) * covariance_(j, j)));
    }
  }

  // Another valley whose bottom is as good as a point of the interval belongs to it.
  void add_other_minima(Profile& profile) {
    for (const SquaresMinimum& other : minima_) {
      if (!other.has_result()) continue;
      const SquaresMinimum found = minimum_from(other.at);
      if (!(found.value - best_.value < fall_)) continue;
      for (long i = 0; i < values_; ++i) {
        ProfileAxis& axis = profile.axes[static_cast<std::size_t>(i)];
        if (found.at[i] < axis.low) std::tie(axis.low, axis.is_low_open) = end_of(i, -1, found);
        if (found.at[i] > axis.high) std::tie(axis.high, axis.is_high_open) = end_of(i, 1, found);
      }
    }
  }

  ProfileAxis axis_of(long i) {
    ProfileAxis axis;
    std::tie(axis.low, axis.is_low_open) = end_of(i, -1, best_);
    if (!is_beaten_) std::tie(axis.high, axis.is_high_open) = end_of(i, 1, best_);
    return axis;
  }

  // The fall of twice the log-likelihood where value i is `at`, from the nearest known point.
  double fall_at(long i, double at, SquaresMinimum& near) {
    Vector start = near.at + (at - near.at[i]) / covariance_(i, i) * covariance_.col(i);
    start = start.cwiseMax(0.0).cwiseMin(1.0);
    start[i] = at;
    SquaresMinimum found = minimum_from(start, i);
    const double fall = found.value - best_.value;
    if (fall < -kNearFall * fall_) best_ = found, is_beaten_ = true;
    if (std::isfinite(fall)) near = std::move(found);
    return fall;
  }

  // The end on one side of a minimum, and whether the likelihood falls too little up to the end of the range. It is
  // searched between a distance inside and one outside. The root of the fall grows evenly where the model is linear.
  std::pair<double, bool> end_of(long i, double side, const SquaresMinimum& minimum) {
    const double limit = side > 0 ? 1 : 0, from = minimum.at[i], whole = std::abs(limit - from);
    if (whole == 0) return {limit, true};
    const double usual = std::sqrt(fall_ * covariance_(i, i));
    double inside = 0, outside = whole, distance = std::min(whole, usual);
    bool is_bracketed = false;
    SquaresMinimum near = minimum;
    for (int n = 0; n < kMostEndTries && outside - inside > kLeastWidth; ++n) {
      const double at = distance == whole ? limit : from + side * distance;
      const double fall = fall_at(i, at, near);
      if (is_beaten_ || std::abs(fall - fall_) < kNearFall * fall_) return {at, false};
      if (fall < fall_ && distance == whole) return {limit, true};
      (fall < fall_ ? inside : outside) = distance;
      is_bracketed |= fall > fall_;
      const double growth = std::isfinite(fall) ? std::sqrt(fall_ / std::max(fall, 0.05 * fall_)) : 0;
      distance = std::min(distance * growth, outside);
      const double margin = 0.05 * (outside - inside);
      if (is_bracketed && (distance < inside + margin || distance > outside - margin))
        distance = 0.5 * (inside + outside);
    }
    return {from + side * outside, !is_bracketed};
  }

  const ProfileInput& input_;
  long values_;
  std::vector<double> weights_;  // of each kind of residual
  Matrix span_;                  // an orthonormal basis of what the other unknowns can do
  LeastSquares method_;
  bool is_scaled_ = false;  // a weight comes from what is left
  std::vector<SquaresMinimum> minima_;
  SquaresMinimum best_;
  Matrix covariance_;
  double free_ = 0;  // degrees of freedom
  double fall_ = kChiSquaredFall;
  bool is_beaten_ = false;  // by a point found on the way
};

}  // namespace

Profile profile_of(const ProfileInput& input) { return Profiling(input).run(); }

}  // namespace rigor::inline analysis
