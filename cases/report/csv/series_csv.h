// Metrics over time as CSV, for --series: time [s] and a column for each metric that has a series. The file stands
// beside the trajectory of its cell.
#pragma once

#include <string>
#include <vector>

#include "cases/runner/recorder.h"

namespace rigor::inline report {

// "case--engine--dt.series.csv", beside "case--engine--dt.csv".
std::string series_file_of(const std::string& trajectory);

// A row for each sample. A series that ends earlier leaves its column empty from there on.
std::string series_csv(const std::vector<double>& times, const std::vector<NamedSeries>& series);

class SeriesRecorder : public Recorder {
 public:
  explicit SeriesRecorder(std::string folder) : folder_(std::move(folder)) {}
  std::string name() const override { return "series"; }
  Recording of_truth(const Case&, const Truth&, const TruthFacts&) const override { return {}; }
  // The file's name.
  Recording of_run(const Case& definition, const Cell& cell, const JudgedRun& run,
                   const std::vector<NamedSeries>& series, const TruthFacts&) const override;
  void discard(const Cell& cell) const override;
  bool still_has(const Cell& cell) const override;

 private:
  std::string path_of(const Cell& cell) const;
  std::string folder_;
};

}  // namespace rigor::inline report
