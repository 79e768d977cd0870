#include "cases/analysis/fitting/minimizer.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace rigor::inline analysis {
namespace {

// A point outside the box stands for its mirror image inside. Moved to a face, it would flatten the simplex.
BoxPoint mirrored(BoxPoint point) {
  for (double& x : point) {
    x = std::abs(std::remainder(x, 2.0));  // from 0 to 1
  }
  return point;
}

double distance(const BoxPoint& a, const BoxPoint& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

class Simplex {
 public:
  Simplex(const std::function<double(const BoxPoint&)>& function, const BoxMinimum& start,
          const SimplexOptions& options)
      : function_(function), options_(options), corners_{start} {
    for (std::size_t i = 0; i < start.at.size(); ++i) {
      BoxPoint point = start.at;
      point[i] += point[i] + options.size <= 1 ? options.size : -options.size;
      corners_.push_back(tried(point));
    }
  }

  std::size_t evaluations() const { return evaluations_; }

  BoxMinimum search() {
    while (true) {
      std::stable_sort(corners_.begin(), corners_.end(),
                       [](const auto& a, const auto& b) { return a.value < b.value; });
      const bool is_enough = corners_.front().value <= options_.enough;
      if (is_enough || evaluations_ >= options_.most || diameter() < options_.tolerance)
        return {mirrored(corners_.front().at), corners_.front().value};
      step();
    }
  }

 private:
  BoxMinimum tried(const BoxPoint& point) {
    ++evaluations_;
    return {point, function_(mirrored(point))};
  }

  double diameter() const {
    double most = 0;
    for (const BoxMinimum& corner : corners_) most = std::max(most, distance(corner.at, corners_.front().at));
    return most;
  }

  // On the line from the worst corner through the middle of the others; 1 is the reflection.
  BoxMinimum beyond(double share) {
    const BoxPoint& worst = corners_.back().at;
    BoxPoint point(worst.size());
    for (std::size_t i = 0; i < point.size(); ++i) {
      double middle = 0;
      for (std::size_t k = 0; k + 1 < corners_.size(); ++k) middle += corners_[k].at[i];
      middle /= static_cast<double>(corners_.size() - 1);
      point[i] = middle + share * (middle - worst[i]);
    }
    return tried(point);
  }

  void step() {
    BoxMinimum& worst = corners_.back();
    const double second = corners_[corners_.size() - 2].value, best = corners_.front().value;
    const BoxMinimum reflected = beyond(1);
    if (reflected.value < best) {
      const BoxMinimum further = beyond(2);
      worst = further.value < reflected.value ? further : reflected;
    } else if (reflected.value < second) {
      worst = reflected;
    } else {
      const BoxMinimum closer = beyond(reflected.value < worst.value ? 0.5 : -0.5);
      if (closer.value < std::min(reflected.value, worst.value)) {
        worst = closer;
      } else {
        shrink();
      }
    }
  }

  void shrink() {
    for (std::size_t k = 1; k < corners_.size(); ++k) {
      BoxPoint point = corners_[k].at;
      for (std::size_t i = 0; i < point.size(); ++i) point[i] = 0.5 * (point[i] + corners_.front().at[i]);
      corners_[k] = tried(point);
    }
  }

  const std::function<double(const BoxPoint&)>& function_;
  const SimplexOptions& options_;
  std::vector<BoxMinimum> corners_;
  std::size_t evaluations_ = 0;
};

}  // namespace

std::vector<BoxPoint> latin_hypercube(std::size_t count, std::size_t axes, unsigned long seed) {
  std::mt19937_64 random(seed);
  // Made by hand: what the standard's distributions draw differs from library to library.
  const auto draw = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::vector<BoxPoint> points(count, BoxPoint(axes));
  for (std::size_t axis = 0; axis < axes; ++axis) {
    std::vector<std::size_t> layers(count);
    std::iota(layers.begin(), layers.end(), std::size_t{0});
    for (std::size_t i = count; i > 1; --i)
      std::swap(layers[i - 1], layers[static_cast<std::size_t>(draw() * static_cast<double>(i))]);
    for (std::size_t i = 0; i < count; ++i)
      points[i][axis] = (static_cast<double>(layers[i]) + draw()) / static_cast<double>(count);
  }
  return points;
}

BoxMinimum nelder_mead(const std::function<double(const BoxPoint&)>& function, const BoxMinimum& start,
                       const SimplexOptions& options) {
  // A new simplex may leave a place in which an old one has become too narrow.
  BoxMinimum best = start;
  std::size_t left = options.most;
  while (true) {
    SimplexOptions rest = options;
    rest.most = left;
    Simplex simplex(function, best, rest);
    const BoxMinimum found = simplex.search();
    left -= std::min(left, simplex.evaluations());
    const bool is_better = found.value < best.value;
    if (is_better) best = found;
    if (!is_better || best.value <= options.enough || left <= start.at.size()) return best;
  }
}

std::vector<BoxMinimum> distinct_starts(std::vector<BoxMinimum> points, std::size_t most, double apart) {
  std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  std::vector<BoxMinimum> starts;
  for (const BoxMinimum& point : points) {
    const bool is_near = std::any_of(starts.begin(), starts.end(),
                                     [&](const BoxMinimum& start) { return distance(point.at, start.at) < apart; });
    if (!is_near && starts.size() < most) starts.push_back(point);
  }
  return starts;
}

}  // namespace rigor::inline analysis
