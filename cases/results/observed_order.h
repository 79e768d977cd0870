// The errors of a run at its several step sizes, and the order that they show.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cases/results/results.h"

namespace rigor {

// The exponent p of value = c dt^p, fitted by least squares to the logarithms. Two points or more.
double fitted_order(const std::vector<double>& dt, const std::vector<double>& values);

// Whether a cell's numbers are the engine's: not if it blew up, crashed, timed out or broke its method's promise.
bool came_to_a_result(const Cell& cell);

// One cell of a run: what it cost and how wrong it was.
struct ErrorPoint {
  StepSize dt;
  double error;  // in the metric's unit; never below what the truth of the case is sure of, see error_floor
  double cost;   // s/s
};

// The cells of a run that came to a result and have both `metric` and a cost, in the order of the run's dt. Those whose
// truth is made by the run's own code are none: what they are off by is not known, and nothing may be compared with it.
std::vector<ErrorPoint> error_points(const CaseResult& result, std::size_t run, const std::string& metric);

// Below it an error says nothing about a scheme: the truth's own error over the run, but not more than a truth may be
// off where it is compared, nor less than 1e-14, a few roundings of a metre or a radian.
double error_floor(const CaseResult& result);

// "position_error", "orientation_error": those by which some run of the case is off by more than 1e-9.
std::vector<std::string> errors_worth_comparing(const CaseResult& result);

struct ObservedOrder {
  std::optional<double> value;  // none where the cells do not show one
  std::string text;             // the errors fitted, or why there is no order
};
// Over the cells, those too that are held to themselves, for such a truth does know how a method converges, that
// `selects` takes, those aside that are within 100 of the floor: there rounding stops the fall.
ObservedOrder observed_order(
    const CaseResult& result, std::size_t run, const std::string& metric,
    const std::function<bool(const StepSize&)>& selects = [](const StepSize&) { return true; });

}  // namespace rigor
