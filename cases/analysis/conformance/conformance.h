// Checks whether an engine meets the seam's contract (core/engine/engine.h), for engines from outside and any other.
// The scenes are small, each with its own truth. Each failure shows the request, the answer and the expected answer.
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
  std::string asks;  // the requirement, as a sentence
  CheckResult (*run)(const Trial& trial);
};

const std::vector<ConformanceCheck>& conformance_checks();  // ordered by their use to an author

// The check's result; an engine that throws, or that does not answer, breaks it.
CheckResult check_result(const ConformanceCheck& check, const Trial& trial);

}  // namespace rigor
