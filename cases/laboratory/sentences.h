// What happens in the laboratory and why, in the words of the report.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "adapters/engines.h"
#include "cases/case/case.h"
#include "cases/report/wording/message.h"
#include "cases/results/results.h"

namespace rigor::inline laboratory {

struct LiveRun {
  std::string run;  // its name
  Cell cell;        // see Experiment::judge
};

// The report's own explanations of these runs, as of a case with one step. `changed` is the case with its sliders.
std::vector<Message> live_explanations(const EngineTable& engines, const Case& changed, const StepSize& dt,
                                       const std::vector<LiveRun>& runs);

// The stiffest spring mode at the start, and what one step makes of its energy: measured by stepping that oscillator.
struct LiveMode {
  double frequency = 0;                  // rad/s
  double largest_step = 0;               // s, of semi-implicit Euler
  std::map<std::string, double> growth;  // by run; one that does not take a spring is missing
};
std::optional<LiveMode> stiffest_mode(const Case& changed, const StepSize& dt, const std::vector<std::string>& runs);

// "The stiffest spring mode has ω = 20 rad/s, so ω dt = 0.66 at dt = 1/30 s. One step multiplies its energy by 1.43
// (core:explicit-euler), 0.991 (core:rk4)."
std::string sentence_on(const LiveMode& mode, const StepSize& dt);

}  // namespace rigor::inline laboratory
