// Whether an engine does what the seam asks (core/engine/engine.h), check by check: for one that comes from outside,
// and any other. Small scenes, each with a truth of its own; whatever fails says what was sent, what came back and what
// was due.
#pragma once

#include <string>
#include <vector>

#include "core/engine/engine.h"

namespace rigor {

struct CheckResult {
  enum class Answer { holds, broken, not_asked } answer = Answer::holds;
  std::string sent, came, due;  // of a check that is broken
  std::string why;              // one was not asked
};

// An engine, and the run of it that is tried.
struct Trial {
  const Engine& engine;
  EngineInfo info;
  Settings settings;
};

struct ConformanceCheck {
  std::string name;
  std::string asks;  // what holds, as a sentence
  CheckResult (*run)(const Trial& trial);
};

const std::vector<ConformanceCheck>& conformance_checks();  // in the order in which they are of use to an author

// The check's result; an engine that throws, or that does not answer, breaks it.
CheckResult check_result(const ConformanceCheck& check, const Trial& trial);

}  // namespace rigor
