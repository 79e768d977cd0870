#include "cases/report/csv/trajectory_csv.h"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace rigor::inline report {

// In half of the time of fmt. Formatting is half of the cost of a run's files.
void append_number(std::string& out, double value) {
  char text[32];
  out.append(text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, 17).ptr);
}

std::string csv_header() {
  std::string header = "time,body";
  for (const char* name : kColumnNames) header += fmt::format(",{}", name);
  return header;
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

void append_csv_rows(std::string& out, const Scene& scene, double time, BodyColumns bodies,
                     const std::string& last_column) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    append_number(out, time);
    out += ',' + csv_field(scene.bodies[i].name);
    for (std::size_t c = 0; c < kColumnNames.size(); ++c) {
      out += ',';
      append_number(out, bodies.column(static_cast<int>(c))[i]);
    }
    out += last_column;
    out += '\n';
  }
}

void write_trajectory(const std::string& path, const Scene& scene, const Trajectory& trajectory) {
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  std::string rows = csv_header() + "\n";
  for (const Sample& sample : trajectory.samples) {
    append_csv_rows(rows, scene, sample.time, sample.bodies.columns());
    constexpr std::size_t kChunk = 1 << 20;
    if (rows.size() > kChunk) file << rows, rows.clear();
  }
  file << rows;
  file.close();
  if (!file) {
    throw std::runtime_error(fmt::format("the trajectory could not be written to '{}': {}", path,
                                         errno == 0 ? "for no reason known" : std::strerror(errno)));
  }
}

Recording TrajectoryRecorder::of_run(const Case& definition, const Cell& cell, const JudgedRun& run,
                                     const std::vector<NamedSeries>&, const TruthFacts&) const {
  write_trajectory(folder_ + "/" + cell.trajectory, definition.scene, run.trajectory);
  return {};
}

void TrajectoryRecorder::discard(const Cell& cell) const {
  std::error_code no_matter;
  std::filesystem::remove(std::filesystem::path(folder_) / cell.trajectory, no_matter);
}

bool TrajectoryRecorder::still_has(const Cell& cell) const {
  return cell.trajectory.empty() || std::filesystem::exists(std::filesystem::path(folder_) / cell.trajectory);
}

}  // namespace rigor::inline report
