// Results as JSON: the messages of a child process to its parent, and the parts of results.json. Both use one form.
#pragma once

#include <string>

#include "cases/results/results.h"
#include "core/base/json_fwd.h"

namespace rigor::inline results {

std::string message_of_truth(const TruthFacts& facts);
std::string message_of_cell(std::size_t index, const Cell& cell, const Scene& scene);
std::string message_of_spreads(const std::vector<Spread>& spreads);
std::string message_of_stable_step(std::size_t run, const StableStepResult& result);

// What a message is about. `index`: of the cell, or of the stable step's run.
struct MessageSubject {
  enum class Part { truth, spreads, cell, stable_step } part = Part::truth;
  std::size_t index = 0;
  bool operator==(const MessageSubject&) const = default;
};

// Fills in the content of the message. Throws std::exception, without any change, for a damaged message: no JSON, a
// missing part, or an unknown cell, status or verdict.
MessageSubject apply_message(CaseResult& result, const std::string& message);

Json json_of(const Cell& cell, const Scene& scene);
Json json_of(const StableStepResult& result);

// JSON has no word for numbers that are not finite: they are written as "inf", "-inf" and "nan". All others come back
// with the same bits. Text that is not UTF-8 is written with replacement characters.
std::string text_of(Json value, int indent);
double number_of(const Json& value);  // throws std::exception for any other JSON

}  // namespace rigor::inline results
