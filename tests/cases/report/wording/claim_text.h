// What the oracle reads of a message: the numbers in its text, and what a claim says about its own.
#pragma once

#include <string>
#include <vector>

#include "cases/report/wording/message.h"
#include "cases/results/results.h"

namespace rigor::test {

bool holds(const Claim& claim);
// The text without names and quotations, in which digits may stand for anything.
std::string without_names(const Results& results, std::string text);
// Those that do not belong to the wording.
std::vector<std::string> numbers_in(std::string text);
// SI value of "31 mm", "4.2 ms", "3.4 %", "0.5 N m s/rad". Of a metric in percent, "3.4 %" is 3.4.
double printed_value(const std::string& quantity, const std::string& printed);

}  // namespace rigor::test
