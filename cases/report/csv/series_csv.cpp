#include "cases/report/csv/series_csv.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "cases/report/csv/trajectory_csv.h"

namespace rigor::inline report {

std::string series_file_of(const std::string& trajectory) {
  return std::filesystem::path(trajectory).replace_extension(".series.csv").string();
}

std::string series_csv(const std::vector<double>& times, const std::vector<NamedSeries>& series) {
  std::string text = "time";
  for (const NamedSeries& one : series) {
    if (!one.values.empty()) text += "," + one.name;
  }
  text += '\n';
  for (std::size_t i = 0; i < times.size(); ++i) {
    append_number(text, times[i]);
    for (const NamedSeries& one : series) {
      if (one.values.empty()) continue;
      text += ',';
      if (i < one.values.size()) append_number(text, one.values[i]);
    }
    text += '\n';
  }
  return text;
}

std::string SeriesRecorder::path_of(const Cell& cell) const {
  return (std::filesystem::path(folder_) / series_file_of(cell.trajectory)).string();
}

Recording SeriesRecorder::of_run(const Case&, const Cell& cell, const JudgedRun& run,
                                 const std::vector<NamedSeries>& series, const TruthFacts&) const {
  std::vector<double> times;
  for (const Sample& sample : run.trajectory.samples) times.push_back(sample.time);
  errno = 0;
  std::ofstream file(path_of(cell), std::ios::binary);
  file << series_csv(times, series);
  file.close();
  if (!file) {
    throw std::runtime_error(fmt::format("the series could not be written to '{}': {}", path_of(cell),
                                         errno == 0 ? "for no reason known" : std::strerror(errno)));
  }
  return {series_file_of(cell.trajectory)};
}

void SeriesRecorder::discard(const Cell& cell) const {
  std::error_code no_matter;
  std::filesystem::remove(path_of(cell), no_matter);
}

bool SeriesRecorder::still_has(const Cell& cell) const {
  return cell.trajectory.empty() || std::filesystem::exists(path_of(cell));
}

}  // namespace rigor::inline report
