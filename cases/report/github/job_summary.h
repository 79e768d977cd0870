// What a CI runner shows: a summary in Markdown, and annotations at the lines of the gates that fell short, as GitHub's
// workflow commands.
#pragma once

#include <string>

#include "cases/gates/failures.h"

namespace rigor::inline report {

// A runner refuses a summary of 1 MiB for all steps together; this leaves room for others'.
inline constexpr std::size_t kLongestSummary = 200000;  // bytes

std::string job_summary(const Results& results, std::size_t longest = kLongestSummary);

// One `::error file=...,line=...::` line a row.
std::string annotations(const std::vector<Failure>& rows);

// One `::warning` line for each gate that held by a run that was stepped in part by less than its method.
std::string warnings(const Results& results);

}  // namespace rigor::inline report
