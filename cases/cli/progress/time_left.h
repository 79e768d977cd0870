// Predicts how long the rest of a grid takes. It learns from the cells that have ended.
//
// A cell's predicted time follows from its steps and bodies, or from an earlier run (measured_times.h). The measured
// times of each engine's cells scale the predictions of its other cells. A prediction counts only once a tenth of the
// work is done and the predicted total has stayed within a quarter since half of the elapsed time. Until then the time
// left is not known.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cases/cli/progress/measured_times.h"
#include "cases/results/results.h"

namespace rigor::inline cli {

// s, of wall time.
struct Estimate {
  double least = 0, most = 0;
};

// s, of a cell on a common machine; engines differ by ten times either way.
double predicted_seconds(const Case& definition, const Cell& cell);
double predicted_search_seconds(const Scene& scene);  // for a largest stable step

class TimeLeft {
 public:
  TimeLeft(const Results& planned, int jobs, const MeasuredTimes& measured);

  void end_cell(std::size_t of_case, std::size_t cell, double wall_seconds);
  void end_search(std::size_t of_case, std::size_t run);

  // After `elapsed` seconds of the run.
  std::optional<Estimate> at(double elapsed);

 private:
  struct Part {
    std::string engine;
    double predicted = 0;  // s
    bool is_measured = false;
    std::optional<double> took = {};  // s
  };
  using Key = std::pair<std::size_t, std::size_t>;  // case; cell or run

  double remaining() const;  // s, of one job

  std::map<Key, Part> cells_, searches_;
  double jobs_, all_ = 0, done_ = 0;                    // s, predicted
  std::vector<std::pair<double, double>> totals_ = {};  // s: elapsed, predicted total
};

}  // namespace rigor::inline cli
