#include "cases/analysis/fitting/bootstrap.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <random>

#include "core/base/eigen_of.h"

namespace rigor::inline analysis {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int kDraws = 1000;     // the ends of a 95 % interval then vary by some percent
constexpr int kRounds = 4;       // of the size of the neighbourhood
constexpr double kFirst = 0.1;   // half of its width along each axis of the box
constexpr double kWidths = 2.5;  // standard deviations that it should be wide
constexpr double kLeast = 1e-6;  // below it the twelve digits of a value end
constexpr double kFlat = 0.05;   // share of draws without a minimum from which an axis counts as flat

// 1, x_i, x_i x_j of the offsets from the best point, in half widths.
Vector terms_of(const Vector& x) {
  const long n = x.size();
  Vector terms((n + 1) * (n + 2) / 2);
  long at = 0;
  terms[at++] = 1;
  for (long i = 0; i < n; ++i) terms[at++] = x[i];
  for (long i = 0; i < n; ++i)
    for (long j = i; j < n; ++j) terms[at++] = x[i] * x[j];
  return terms;
}

struct QuadraticForm {
  Vector slope;
  Matrix curvature;
};

QuadraticForm parabola_of(const Vector& coefficients, long n) {
  QuadraticForm one{coefficients.segment(1, n), Matrix(n, n)};
  long at = n + 1;
  for (long i = 0; i < n; ++i)
    for (long j = i; j < n; ++j) {
      const double value = coefficients[at++];
      one.curvature(i, j) = one.curvature(j, i) = i == j ? 2 * value : value;
    }
  return one;
}

// The neighbourhood of the best point, with a parabola for each trial.
class Neighbourhood {
 public:
  Neighbourhood(const BoxPoint& best, const Vector& half, const LossesOfTrials& losses, unsigned long seed)
      : best_(best), half_(half) {
    const long n = half.size(), terms = (n + 1) * (n + 2) / 2;
    const auto count = static_cast<std::size_t>(3 * terms);
    std::vector<BoxPoint> points = latin_hypercube(count, best.size(), seed);
    Matrix design(static_cast<long>(count), terms);
    for (std::size_t p = 0; p < count; ++p) {
      Vector offset(n);
      for (long i = 0; i < n; ++i) {
        const auto axis = static_cast<std::size_t>(i);
        const double low = std::max(0.0, best[axis] - half[i]), high = std::min(1.0, best[axis] + half[i]);
        points[p][axis] = low + points[p][axis] * (high - low);
        offset[i] = (points[p][axis] - best[axis]) / half[i];
      }
      design.row(static_cast<long>(p)) = terms_of(offset).transpose();
    }
    const std::vector<std::vector<double>> found = losses(points);
    Matrix values(static_cast<long>(count), static_cast<long>(found.front().size()));
    for (std::size_t p = 0; p < count; ++p)
      for (std::size_t t = 0; t < found[p].size(); ++t)
        values(static_cast<long>(p), static_cast<long>(t)) = found[p][t];
    coefficients_ = least_squares(design, values);
  }

  // Draws minima, as offsets in the box; `flat` counts draws without a minimum along each axis.
  Matrix draw(unsigned long seed, std::vector<int>& flat) const {
    const long n = half_.size(), trials = coefficients_.cols();
    std::mt19937_64 random(seed);
    Matrix minima(kDraws, n);
    for (int d = 0; d < kDraws; ++d) {
      Vector sum = Vector::Zero(coefficients_.rows());
      for (long t = 0; t < trials; ++t)
        sum += coefficients_.col(static_cast<long>(random() % static_cast<unsigned long>(trials)));
      minima.row(d) = minimum_of(sum, flat).transpose();
    }
    return minima;
  }

 private:
  // Along a direction without curvature, and past the box, the minimum is on the box's face.
  Vector minimum_of(const Vector& sum, std::vector<int>& flat) const {
    const long n = half_.size();
    const QuadraticForm one = parabola_of(sum, n);
    const DenseEigen parts = dense_eigen_of(one.curvature);
    const double largest = parts.values.cwiseAbs().maxCoeff();
    Vector offset = Vector::Zero(n);
    for (long k = 0; k < n; ++k) {
      const Vector direction = parts.vectors.col(k);
      const double slope = direction.dot(one.slope), curvature = parts.values[k];
      constexpr double kNoCurvature = 1e-9;
      if (curvature > kNoCurvature * largest && curvature > 0) {
        offset -= slope / curvature * direction;
        continue;
      }
      for (long i = 0; i < n; ++i)
        if (std::abs(direction[i]) > 0.5) ++flat[static_cast<std::size_t>(i)];
    }
    for (long i = 0; i < n; ++i) {
      const double best = best_[static_cast<std::size_t>(i)];
      offset[i] = std::clamp(best + half_[i] * offset[i], 0.0, 1.0) - best;
    }
    return offset;
  }

  const BoxPoint& best_;
  Vector half_;
  Matrix coefficients_;  // a column for each trial
};

// Half the width that holds the middle 68 % of the values: no single far one makes it large.
double robust_deviation(Vector values) {
  std::sort(values.data(), values.data() + values.size());
  const auto at = [&](double share) {
    return values[static_cast<long>(share * static_cast<double>(values.size() - 1))];
  };
  return 0.5 * (at(0.8413) - at(0.1587));
}

BootstrapAxis interval_of(Vector values, double best, double widening) {
  std::sort(values.data(), values.data() + values.size());
  const auto at = [&](double share) {
    return values[static_cast<long>(share * static_cast<double>(values.size() - 1))];
  };
  const double middle = at(0.5);
  // About the best point, which need not be the parabola's minimum: the distance between the two is part of the doubt.
  const double low = std::min(middle, 0.0) + widening * (at(0.025) - middle);
  const double high = std::max(middle, 0.0) + widening * (at(0.975) - middle);
  return {std::clamp(best + low, 0.0, 1.0), std::clamp(best + high, 0.0, 1.0)};
}

std::vector<std::vector<double>> correlations_of(const Matrix& minima) {
  const long n = minima.cols();
  const Matrix centred = minima.rowwise() - minima.colwise().mean();
  std::vector<std::vector<double>> all(static_cast<std::size_t>(n),
                                       std::vector<double>(static_cast<std::size_t>(n), 1));
  for (long i = 0; i < n; ++i)
    for (long j = 0; j < n; ++j) {
      const double scale = centred.col(i).norm() * centred.col(j).norm();
      all[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = i == j ? 1
                                                                      : scale > 0
                                                                          ? centred.col(i).dot(centred.col(j)) / scale
                                                                          : 0;
    }
  return all;
}

// A sample of n trials knows its own spread only roughly, and the bootstrap's spread is that of the sample.
double widening_of(std::size_t trials) {
  const auto n = static_cast<double>(trials);
  const double normal = 1.959963984540054;
  return boost::math::quantile(boost::math::students_t(n - 1), 0.975) / normal * std::sqrt(n / (n - 1));
}

}  // namespace

Bootstrap bootstrap_around(const BoxPoint& best, const LossesOfTrials& losses, unsigned long seed) {
  const auto n = static_cast<long>(best.size());
  Vector half = Vector::Constant(n, kFirst);
  std::vector<int> flat;
  Matrix minima;
  std::size_t trials = 0;
  const LossesOfTrials counted = [&](const std::vector<BoxPoint>& points) {
    auto found = losses(points);
    trials = found.front().size();
    return found;
  };
  for (int round = 0; round < kRounds; ++round) {
    flat.assign(best.size(), 0);
    minima = Neighbourhood(best, half, counted, seed + static_cast<unsigned long>(round)).draw(seed, flat);
    bool is_right = true;
    for (long i = 0; i < n; ++i) {
      const double wanted = std::clamp(kWidths * robust_deviation(minima.col(i)), kLeast, 0.5);
      if (wanted < 0.5 * half[i] || wanted > 2 * half[i]) is_right = false;
      half[i] = wanted;
    }
    if (is_right) break;
  }
  Bootstrap result;
  for (long i = 0; i < n; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    result.axes.push_back(interval_of(minima.col(i), best[axis], widening_of(trials)));
    result.axes.back().is_curved = flat[axis] < kFlat * kDraws;
  }
  result.correlations = correlations_of(minima);
  return result;
}

}  // namespace rigor::inline analysis
