// The true motion of a scene: every body's state as a function of time, with an estimate of its own error. A closed
// form is a small pure class that cites its source and checks on construction that it applies to the scene.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/engine/body_table.h"
#include "core/scene/scene.h"

namespace rigor::inline truth {

class Truth {
 public:
  virtual ~Truth() = default;
  // The state of every body at t [s], 0 <= t <= the duration it was made for, into columns of the scene's size.
  virtual void at(double t, MutableBodyColumns out) const = 0;
  // Estimated error of at(t): the largest over all bodies of the position's [m] and the orientation's [rad]. Never
  // falls as t grows.
  virtual double error(double t) const = 0;
  // A sentence on what no computation of this motion can decide; empty if there is nothing of the kind.
  virtual std::string caveat() const { return ""; }
};

// The last instant in [0, duration] up to which the truth's own error stays within `tolerance`.
double horizon(const Truth& truth, double tolerance, double duration);

// A row of the table in truths.cpp.
struct TruthRow {
  std::string name;     // what truth.kind says
  std::string summary;  // one line, with the source
  // Throws InputError with a sentence that names the required scene.
  std::function<std::unique_ptr<Truth>(const Scene& scene, double duration)> make;
};

const std::vector<TruthRow>& truths();  // alphabetical; "none" is not a row

// The row's truth, or null for "none".
std::unique_ptr<Truth> make_truth(const std::string& kind, const Scene& scene, double duration);

}  // namespace rigor::inline truth
