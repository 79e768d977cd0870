// The two runs whose difference is explained, and the common steps in which they are compared.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "adapters/engines.h"
#include "cases/analysis/mistakes/motions.h"
#include "cases/case/case.h"

namespace rigor::inline analysis {

struct DivergingRun {
  RunName name;
  StepSize dt{0, ""};
};

struct DivergenceOptions {
  int jobs = 1;
  double limit = 120;  // s of CPU time for a run
  std::function<void()> on_motion = {};
};

// One common step is `steps_a` steps of A and `steps_b` steps of B.
struct CommonSteps {
  long steps_a = 1, steps_b = 1;
  double seconds = 0;  // of a common step
  long count = 0;      // in the duration
};
// Throws InputError if the two steps have no common multiple that is short enough to compare at.
CommonSteps common_steps(const StepSize& a, const StepSize& b, double duration);

// Makes the tasks of both runs and computes them.
class RunPair {
 public:
  enum class Side { a, b };

  RunPair(const EngineTable& engines, DivergingRun a, DivergingRun b, CommonSteps steps, DivergenceOptions options)
      : engines_(engines), a_(std::move(a)), b_(std::move(b)), steps_(steps), options_(std::move(options)) {}

  const EngineTable& engines() const { return engines_; }
  const DivergingRun& run(Side side) const { return side == Side::a ? a_ : b_; }
  const CommonSteps& steps() const { return steps_; }
  // So many common steps of the scene, each as one sample. `finer`: each step of the run is divided into so many.
  MotionTask task(Side side, std::shared_ptr<const Scene> scene, long common, long finer = 1) const;
  std::vector<StateSeries> motions(const std::vector<MotionTask>& tasks) const;

 private:
  const EngineTable& engines_;
  DivergingRun a_, b_;
  CommonSteps steps_;
  DivergenceOptions options_;
};

}  // namespace rigor::inline analysis
