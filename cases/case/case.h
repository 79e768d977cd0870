// A case: a scene, how to run it, what the truth is, and the gates it must pass. One TOML file of cases/suite/ each.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace rigor {

struct StepSize {
  double seconds;
  std::string text;  // as it was written, "1/30": what tables and file names show
};

// Whether it is the same step, however written: "1/30" and "0.03333333333". They agree to a billionth, by which steps
// are rounded where they are counted as well: the runs are as long to within that part of a step's count.
bool operator==(const StepSize& a, const StepSize& b);

// What a metric's value is held against. Exactly one of the limits is set (an empty better_than is none), or min and
// max together. All but `regression` are bounds: they hold whoever wrote the engine. A regression guards a value that
// was measured, and stands beside the engine (cases/gates/regression.h), against change.
struct Gate {
  std::string metric;                // a row of metrics.cpp
  std::vector<std::string> engines;  // run names; empty: every engine that supports the scene
  std::vector<StepSize> dt;          // empty: every dt of the run
  std::optional<double> max, min, equals, at_least_order;
  bool declares_order = false;       // at_least_order is how far a run may fall short of what its method declares
  std::optional<double> regression;  // > 1: by how much the value may differ from the one recorded, either way
  std::string better_than = "";      // a run's name, at the same dt: the value must be better than its value
  std::string because;
  std::string where;          // "file:line:column" of the gate
  bool is_of_family = false;  // of the folder's family.toml: of a case where it meets no cell it says nothing
};

// "bound" or "regression", as reports call them.
std::string kind_of(const Gate& gate);

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
  std::vector<Gate> gates;
  std::string text;  // the file itself
};

// Reads a duration or step size in seconds, "0.01" or "1/30". Throws InputError unless positive and finite and, for a
// fraction, made of two plain numbers. `what` begins the message: "--dt".
StepSize parse_step_size(const std::string& text, const std::string& what);

// Throws InputError, its message begun by `what`, for a step longer than the run or one that a run has too many of.
void check_step_size(const StepSize& dt, double duration, const std::string& what);

}  // namespace rigor
