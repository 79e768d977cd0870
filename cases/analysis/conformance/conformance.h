// Checks whether an engine obeys the seam (core/engine/engine.h). It serves engines from outside first, and all others.
// Each check uses a small scene with a truth of its own. A failed check reports the call, the answer and the due
// answer.
#pragma once

#include <string>
#include <vector>

#include "core/engine/engine.h"

namespace rigor::inline analysis {

struct CheckResult {
  enum class Answer { holds, broken, not_asked } answer = Answer::holds;
  std::string sent, came, due;  // of a broken check
  std::string why;              // of a check that was not asked
};

// An engine and the run that is tried.
struct Trial {
  const Engine& engine;
  EngineInfo info;
  Settings settings;
};

struct ConformanceCheck {
  std::string name;
  std::string asks;  // the requirement, as a sentence
  CheckResult (*run)(const Trial& trial);
};

const std::vector<ConformanceCheck>& conformance_checks();  // in the order in which an author needs them

// Runs the check. An engine that throws or does not answer breaks it.
CheckResult check_result(const ConformanceCheck& check, const Trial& trial);

}  // namespace rigor::inline analysis
