// Finds bodies that have passed through each other, also between two samples. Of two bodies that overlap, at least the
// thinner one must have been passed: the overlap is deeper than half its thickness, and they come apart on the far
// side. Half-spaces are left out, for nothing leaves them on the far side; such a body stays overlapping.
//
// Between two samples the path counts only where it is known:
//   by the scheme       both bodies have moved along straight lines, x1 = x0 + h v1, as semi-implicit steps do
//   by free flight      no impulse has changed the velocity with which they approach, so nothing has stopped them
// A body that bounces inside a step may come to the far side by itself.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/engine/body_table.h"
#include "core/scene/scene.h"

namespace rigor::inline metric {

struct Passage {
  int a = 0, b = 0;  // the bodies
  double time = 0;   // s, at which they are apart again
};

class Tunnelling {
 public:
  explicit Tunnelling(const Scene& scene);

  // Whether any two bodies could pass through each other: two that collide, are no half-spaces, and one of which moves.
  bool is_possible() const { return is_possible_; }

  // The bodies at the next instant. Returns the first pair that is found to have passed through by then.
  // `is_step`: one step of the engine leads here from the instant before.
  std::optional<Passage> go_on(double time, BodyColumns bodies, bool is_step);

 private:
  using Pair = std::pair<int, int>;
  struct Overlapping {
    BodyState a, b;          // when they were last apart
    bool is_deep = false;    // since then
    bool was_apart = false;  // ever
  };
  struct Path {
    BodyState from, to;
    bool is_straight;  // by the scheme
  };

  std::vector<Pair> near_pairs(BodyColumns bodies) const;
  bool has_passed(const Pair& pair, double h, BodyColumns bodies, bool is_step);
  Path path_of(int body, double h, BodyColumns bodies, bool is_step) const;
  bool is_beyond(const Pair& pair, const Path& a, const Path& b) const;
  double length_of(const Pair& pair, const Path& a, const Path& b) const;
  bool is_known(const Pair& pair, const Path& a, const Path& b, double h) const;
  double deep(const Pair& pair) const;  // m, half the thickness of the thinner one
  double gap(const Pair& pair, const BodyState& a, const BodyState& b) const;
  // The share of the way at which they first are as near as `nearest` [m], if they ever are.
  std::optional<double> first_within(const Pair& pair, const Path& a, const Path& b, double nearest) const;

  const Scene& scene_;
  bool is_possible_ = false;
  std::vector<double> radii_, inradii_;  // m
  double time_ = 0;                      // s, of before_
  BodyTable before_;                     // empty until the first instant is seen
  std::map<Pair, Overlapping> overlapping_;
};

}  // namespace rigor::inline metric
