// One run's values of a metric at a case's steps, which diagnoses read.
#pragma once

#include "cases/analysis/diagnosis.h"

namespace rigor::inline analysis {

// From the coarsest step to the finest, without cells that have no value or blew up.
struct MetricOverSteps {
  std::vector<const Cell*> cells;
  std::vector<const MetricValue*> values;

  bool empty() const { return cells.empty(); }
};

MetricOverSteps metric_over_steps(const CaseResult& result, std::size_t run, const std::string& metric);

// The runs that the case has cells of, ascending.
std::vector<std::size_t> runs_of(const CaseResult& result);

// The engine's report of the setting in force, "" if there is none; and as a sentence.
std::string setting_of(const Cell& cell, const std::string& setting);
std::string in_its_words(const Cell& cell, const std::string& setting);

// The value of the series at its n-th step.
Diagnosis diagnosis_of(const char* topic, const CaseResult& result, const MetricOverSteps& series, std::size_t n,
                       double value, const std::string& cause);

}  // namespace rigor::inline analysis
