// Measures how much of an engine's error a known mistake explains, one observation at a time. An observation is one
// part of a view:
// - the state as loaded, before any step. The scheme has no share in it.
// - the first half of the motion. A mistake may make the motion chaotic later.
// - the second half.
// - the last sample, if bodies touch. The way by which a body came to rest has no share in it.
#pragma once

#include <vector>

#include "cases/analysis/mistakes/views.h"

namespace rigor::inline analysis {

// Root mean squares over samples and bodies. Each group of columns is divided by the scale of the motion without
// mistakes: the longest path, a whole turn, the highest speed and the highest spin.
struct Distances {
  double error = 0;        // from the motion without mistakes to the engine's
  double predicted = 0;    // from the motion without mistakes to the one with the mistake
  double rest = 0;         // from the motion with the mistake to the engine's
  double together = 0;     // the inner product of the first two differences
  bool ends_alike = true;  // both motions blow up, or neither does
};

class Observation {
 public:
  enum class Part { loaded, early, late, end };
  // `base`: the motion without mistakes.
  Observation(const View& view, std::size_t view_index, Part part, const Sight& base, std::size_t bodies);

  Distances distances(const Sight& engine, const Sight& mistake) const;
  // The distance of a sight from its own coarse one. It bounds the error of extrapolation, or shows chaos.
  double uncertainty(const Sight& sight) const;
  // Ends where the engine's motion is lost: it blows up, or its steps do not resolve it, and it is far from the base.
  Observation until_lost(const Sight& engine) const;
  bool is_empty() const { return begin_ == end_; }
  // The scaled difference of a sight from the base.
  std::vector<double> difference(const Sight& sight) const;

  std::size_t view_index() const { return view_; }
  bool is_loaded() const { return part_ == Part::loaded; }
  double tolerance() const { return tolerance_; }  // smaller distances say nothing

 private:
  double weight(std::size_t i) const;

  std::size_t view_;
  Part part_;
  const Sight& base_;
  std::size_t sample_;       // numbers of all bodies at one instant
  std::size_t begin_, end_;  // of the states
  double per_ = 1;           // samples times bodies
  double tolerance_;
  double weights_[kMotionColumns];
};

// The observations of all views that have a base.
std::vector<Observation> observations_of(const std::vector<View>& views, const std::vector<Sight>& bases,
                                         const std::vector<ProbeScene>& probes);

}  // namespace rigor::inline analysis
