// How much of an engine's error a known mistake explains, observation by observation. An observation is a part of a
// view: the state as loaded, before any step, in which no scheme has a share; the motion after it, in two halves, for
// what a mistake makes chaotic is told apart in the first alone; and where bodies touch, the end, in which how an
// engine pushed a body to where it lies has no share.
#pragma once

#include <vector>

#include "cases/analysis/mistakes/views.h"

namespace rigor {

// Distances as roots of mean squares over samples and bodies, each group of columns by the scale of the motion without
// mistakes: the longest way, a whole turn, the highest speed and spin.
struct Distances {
  double error = 0;        // of the engine from the motion without mistakes
  double predicted = 0;    // of the mistake from that
  double rest = 0;         // of the engine from the mistake
  double together = 0;     // the inner product of the two differences
  bool ends_alike = true;  // both blow up, or neither
};

class Observation {
 public:
  enum class Part { loaded, early, late, end };
  // `base`: without mistakes.
  Observation(const View& view, std::size_t view_index, Part part, const Sight& base, std::size_t bodies);

  Distances distances(const Sight& engine, const Sight& mistake) const;
  // Distance of a sight from its own coarse one: what extrapolation, or chaos, leaves open.
  double uncertainty(const Sight& sight) const;
  // As far as the engine's motion says where it goes: where it blows up, or grows beyond what its steps resolve, not on
  // from where it has left by many times its size.
  Observation until_lost(const Sight& engine) const;
  bool is_empty() const { return begin_ == end_; }
  // The scaled difference of a sight from the base.
  std::vector<double> difference(const Sight& sight) const;

  std::size_t view_index() const { return view_; }
  bool is_loaded() const { return part_ == Part::loaded; }
  double tolerance() const { return tolerance_; }  // below it nothing is seen

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

// Each of which has an engine's error in it, or a mistake's that the engine does not have.
std::vector<Observation> observations_of(const std::vector<View>& views, const std::vector<Sight>& bases,
                                         const std::vector<ProbeScene>& probes);

}  // namespace rigor
