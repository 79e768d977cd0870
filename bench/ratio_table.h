// The table of bench/run: how many times faster one run is than another, and the goal. Round k of one run is compared
// with round k of the other, which ran near it in time. The table shows the median and the range of these ratios.
#pragma once

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

namespace rigor::bench {

struct RatioRow {
  enum class Kind { times_as_fast, at_most_times, at_most_percent_more };
  std::string what;
  std::string of, against;  // benchmarks: the measured one, and the one for comparison
  Kind kind;
  double goal;  // 0: none, a bound for the rows above it
};
const std::vector<RatioRow>& ratio_rows();

// A regular expression for the benchmarks that the table needs, and those shown below it.
std::string filter_of_table();

// Collects the timings; prints the table at the end.
class RatioTable : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;

 private:
  using Rounds = std::vector<double>;  // ns per body and step, or ns
  void print_row(const RatioRow& row);
  std::string reached_by(const RatioRow& row) const;
  void print_alone(const std::string& name);
  void print_growth();

  std::map<std::string, Rounds> ns_;
  std::map<std::string, std::map<std::string, double>> counters_;
  std::map<std::string, std::string> skipped_;
};

}  // namespace rigor::bench
