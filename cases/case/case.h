// A case: a scene, how to run it, its truth, and the gates it must pass. Each is one TOML file of cases/suite/.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/scene/left_out.h"
#include "core/scene/scene.h"

namespace rigor::inline cases {

struct StepSize {
  double seconds;
  std::string text;  // as it was written, "1/30": what tables and file names show
};

// Whether two steps are equal in any notation: "1/30" and "0.03333333333". They may differ by a billionth, the same
// rounding that counts steps. Runs then have the same length up to that part of a step.
bool operator==(const StepSize& a, const StepSize& b);

// The limits of a metric. Bounds, orders and rankings hold for any engine. A regression guards a measured value against
// change, and its recorded values stand beside the engine (cases/gates/regression.h).
struct BoundLimit {
  std::optional<double> max = {}, min = {}, equals = {};  // max, min or both, or equals alone
};
struct OrderLimit {
  double at_least = 0;
  bool is_declared = false;  // at_least is how far a run may fall short of the order that its method declares
};
struct RankingLimit {
  std::string better_than;  // a run's name, at the same dt: the value must be better than its value
};
struct RegressionLimit {
  double factor = 0;  // above 1: by how much the value may differ from the recorded one, either way
};
using GateLimit = std::variant<BoundLimit, OrderLimit, RankingLimit, RegressionLimit>;

struct Gate {
  std::string metric;                // a row of metrics.cpp
  std::vector<std::string> engines;  // run names; empty: every engine that supports the scene
  std::vector<StepSize> dt;          // empty: every dt of the run
  GateLimit limit;
  std::string because;
  std::string where;          // "file:line:column" of the gate
  bool is_of_family = false;  // of the folder's family.toml: of a case where it meets no cell it says nothing

  const OrderLimit* order() const { return std::get_if<OrderLimit>(&limit); }
  const RankingLimit* ranking() const { return std::get_if<RankingLimit>(&limit); }
  const RegressionLimit* regression() const { return std::get_if<RegressionLimit>(&limit); }
  // All empty for another kind of limit.
  BoundLimit bound() const {
    const auto* own = std::get_if<BoundLimit>(&limit);
    return own ? *own : BoundLimit();
  }
};

// "bound" or "regression", as reports call them.
std::string kind_of(const Gate& gate);

struct MotionRecording;

struct Case {
  std::string id;  // "springs/fixed-spring": its path in the suite; or the path as given, for a file elsewhere
  std::string title;
  std::string source;
  Scene scene;
  double duration = 0;  // s
  std::vector<StepSize> dt;
  int ensemble = 0;            // starts 1e-6 apart that each run is repeated from (runner/ensemble.h); 0: none
  std::string truth = "none";  // a row of truths.cpp, or "none"
  std::string truth_where;     // "file:line:column" of truth.kind
  // Of the truth 'recording': what the case's file names, and that file's own path. Null if it is not on this machine.
  std::shared_ptr<const MotionRecording> recording;
  std::string path;
  std::vector<Gate> gates;
  std::string text;          // the file itself; of a robot, the case file that the import makes
  std::vector<Loss> losses;  // of the import of a robot's file
};

// Reads a duration or step size in seconds, "0.01" or "1/30". Throws InputError unless positive and finite and, for a
// fraction, made of two plain numbers. `what` begins the message: "--dt".
StepSize parse_step_size(const std::string& text, const std::string& what);

// Throws InputError, its message begun by `what`, for a step longer than the run or one that a run has too many of.
void check_step_size(const StepSize& dt, double duration, const std::string& what);

}  // namespace rigor::inline cases
