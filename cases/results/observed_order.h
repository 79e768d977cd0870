// The errors of a run at its several step sizes, and the order that they show.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cases/results/results.h"

namespace rigor::inline results {

// The exponent p of value = c dt^p, fitted by least squares to the logarithms. Two points or more.
double fitted_order(const std::vector<double>& dt, const std::vector<double>& values);

// Whether a cell's numbers are the engine's: not if it blew up, crashed, timed out or broke its method's promise.
bool came_to_a_result(const Cell& cell);

// One cell of a run: what it cost and how wrong it was.
struct ErrorPoint {
  StepSize dt;
  double error;  // in the metric's unit; at least the uncertainty of the case's truth, see error_floor
  double cost;   // s/s
};

// The finished cells of a run that have both `metric` and a cost, in the order of the run's dt. Cells whose truth comes
// from the run's own code are left out: their error is unknown and must not be compared.
std::vector<ErrorPoint> error_points(const CaseResult& result, std::size_t run, const std::string& metric);

// An error below this value says nothing about a scheme. It is the truth's own error over the run. It is at most the
// error that a comparable truth may have, and at least 1e-14, a few roundings of a metre or a radian.
double error_floor(const CaseResult& result);

// "position_error", "orientation_error": those in which some run of the case exceeds 1e-9.
std::vector<std::string> errors_worth_comparing(const CaseResult& result);

struct ObservedOrder {
  std::optional<double> value;  // none where the cells do not show one
  std::string text;             // the errors fitted, or why there is no order
};
// The order over the cells that `selects` accepts. Cells compared with their own code count, because such a truth shows
// convergence. Cells within 100 times the floor are left out, because rounding stops the convergence there.
ObservedOrder observed_order(
    const CaseResult& result, std::size_t run, const std::string& metric,
    const std::function<bool(const StepSize&)>& selects = [](const StepSize&) { return true; });

}  // namespace rigor::inline results
