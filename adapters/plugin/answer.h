// Strict reader of an answer by an engine from outside. An invalid one is an EngineFailure that quotes it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/json_fwd.h"
#include "core/engine/body_table.h"
#include "core/engine/capabilities.h"
#include "core/engine/engine_failure.h"

namespace rigor::inline adapters {

// The state is no longer finite, by the engine's own word.
class EngineDiverged : public EngineFailure {
 public:
  EngineDiverged(const std::string& sentence, int body) : EngineFailure(FailureKind::diverged, sentence), body_(body) {}
  int body() const { return body_; }  // index; 0 where it does not say

 private:
  int body_;
};

// What an answer was asked for, for messages and checks.
struct Question {
  std::string engine;  // as messages call it
  std::string call;
  std::optional<int> world = {};
};

// The object in the line, if it says "ok": true. Throws EngineFailure: unsupported, diverged (EngineDiverged) or
// crashed, as the engine says; invalid for a line that does not answer the request.
Json parsed_answer(const std::string& line, const Question& asked);

// Reads "bodies": a row of thirteen finite numbers for each. Throws EngineFailure (invalid) for anything else.
void read_bodies(const Json& answer, const Question& asked, MutableBodyColumns into);

// Reads "contacts". Throws EngineFailure (invalid) for one with a missing key, or a value of another type or size.
std::vector<ReportedContact> read_contacts(const Json& answer, const Question& asked);

// Reads "reactions": one for each of the joints, of a body of the scene. Throws EngineFailure (invalid) likewise.
std::vector<ReportedReaction> read_reactions(const Json& answer, const Question& asked, std::size_t joints,
                                             std::size_t bodies);

// Checks "time" [s]: the expected time after so many steps, up to roundings of a clock in single precision.
void check_time(const Json& answer, const Question& asked, double due, double dt);

bool is_time(double time, double due, double dt);
void check_time(double time, const Question& asked, double due, double dt);

[[noreturn]] void refuse_answer(const Question& asked, const std::string& fault);

}  // namespace rigor::inline adapters
