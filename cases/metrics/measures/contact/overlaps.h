// The overlap of bodies' shapes beyond that of the scene's start, by the judge's own geometry (shape_gap.h).
#pragma once

#include <functional>
#include <map>
#include <utility>

#include "core/engine/body_table.h"
#include "core/scene/scene.h"

namespace rigor::inline metric {

struct Overlap {
  int a, b;      // the bodies
  double depth;  // m, beyond that at the start; may be negative
  double gap;    // m, between the surfaces: negative
};

class Overlaps {
 public:
  explicit Overlaps(const Scene& scene);

  // Each pair that overlaps at these poses.
  void visit(BodyColumns bodies, const std::function<void(const Overlap&)>& see) const;

 private:
  const Scene& scene_;
  std::map<std::pair<int, int>, double> at_start_;  // m
};

}  // namespace rigor::inline metric
