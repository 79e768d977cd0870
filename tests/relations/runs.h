// The motions that relations are checked on: of truths, of the core's methods and of engines.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/engine/body_table.h"
#include "core/scene/scene.h"

namespace rigor::test {

struct Motion {
  std::vector<BodyTable> states;  // at equal steps from t = 0
  std::vector<double> claims;     // m and rad: of a truth, what it claims as its error in each; else empty
  std::size_t end = 0;            // the last state for which the method keeps its promise
};

struct MotionSource {
  std::string name;
  double step;  // s: between two states
  int steps;
  // m and rad: the most that equivalent motions may be apart, beside what a truth claims.
  double rounding;
  double thresholds = 0;    // the same, that thresholds of contacts, limits and motors add
  double tolerance = 0;     // of each step in SI units: for an adaptive method, and for one that such a method starts
  bool keeps_bits = false;  // in units of powers of two
  bool takes_binary_units = true;  // of 2^-12 to 2^12, which no other engine is made for
  // Whether a scene may be left out. An engine need not support every scene.
  std::function<bool(const Scene& scene)> supports = {};
  std::function<Motion(const Scene& scene, double step, int steps)> motion = {};
  // Whether a threshold chooses between two ways of a step, of the same order. Then only the motion is kept.
  bool has_two_ways = false;
  bool is_symmetric = false;  // in time
  bool is_one_step = true;    // the state tells the next step
};

MotionSource run_of_truth(const std::string& truth, double duration, int samples);
// `name`: as in "core:rk4" or "bullet".
MotionSource run_of_engine(const std::string& name, double step, int steps, double rounding);

}  // namespace rigor::test
