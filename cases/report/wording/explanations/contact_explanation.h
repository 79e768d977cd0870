// Errors of contacts: the measured values, and the engine's own setting that explains them.
#pragma once

#include <vector>

#include "cases/analysis/contact_diagnosis.h"
#include "cases/report/wording/message.h"

namespace rigor::inline report {

std::vector<Message> contact_explanations(const Results& results, const CaseResult& result);

// A metric over the steps of one run, as text: "0.3 at dt = 1/30, 0.1 at 1/60 s". States each value as a claim.
std::string text_over_steps(const Results& results, const Diagnosis& found, const std::string& metric,
                            const std::string& unit, Claims& claims);

// A claim about a diagnosis' first run at one of its steps.
Claim claim_of(const Results& results, const Diagnosis& found, const StepSize& dt, const std::string& quantity,
               double value);

}  // namespace rigor::inline report
