// Results as JSON: what a child process tells its parent, and the parts of results.json. One form serves both.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cases/results/results.h"

namespace rigor {

std::string message_of_truth(const TruthFacts& facts);
std::string message_of_cell(std::size_t index, const Cell& cell, const Scene& scene);
std::string message_of_spreads(const std::vector<Spread>& spreads);
std::string message_of_stable_step(std::size_t run, const StableStepResult& result);

// Fills in what the message says. True if it ends a cell or a stable step.
bool apply_message(CaseResult& result, const std::string& message);

// Numbers that are not finite become null. Text that is not UTF-8 is written with replacement characters.
nlohmann::ordered_json json_of(const Cell& cell, const Scene& scene);
nlohmann::ordered_json json_of(const StableStepResult& result);
std::string text_of(const nlohmann::ordered_json& value, int indent);

}  // namespace rigor
