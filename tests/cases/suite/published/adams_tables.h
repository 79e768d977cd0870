// The cases of MSC ADAMS in published/: the figures that are cited, and the whole tables where they are at hand.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/math.h"

namespace rigor::test {

// What a table's numbers may miss beside the rounding of their last digit: ADAMS's own error.
struct AdamsError {
  double position = 0;  // m
  double rotation = 0;  // rad
  double force = 0;     // N
  double couple = 0;    // N m
};

inline std::ostream& operator<<(std::ostream& out, const AdamsError& error) {
  return out << error.position << " m, " << error.rotation << " rad, " << error.force << " N, " << error.couple
             << " N m";
}

struct AdamsCase {
  std::string id, table, load;  // the table of Project Chrono, and the part of its names that tells several loads apart
  int digits;
  AdamsError error;
  Vec3 marker = Vec3::Zero();  // m: of the joint on the ground, about which its couple is
};

// One instant of a table; adams_figures.csv says what its columns are.
struct AdamsFigures {
  double time;  // s
  Vec3 position;
  Quat orientation;
  Vec3 force, couple;  // on the ground
  Vec3 drive;          // on the body
  bool has_drive = false;
};

using AdamsTable = std::vector<AdamsFigures>;

inline AdamsFigures adams_figures(const std::vector<double>& row) {
  const auto vector = [&](std::size_t k) { return Vec3(row.at(k), row.at(k + 1), row.at(k + 2)); };
  AdamsFigures figures{row.at(0), vector(1),  Quat(row.at(4), row.at(5), row.at(6), row.at(7)).normalized(),
                       vector(8), vector(11), Vec3::Zero()};
  figures.has_drive = row.size() > 14;
  if (figures.has_drive) figures.drive = vector(14);
  return figures;
}

// By case.
inline std::map<std::string, AdamsTable> cited_adams_figures(const std::filesystem::path& file) {
  std::map<std::string, AdamsTable> tables;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#') || line.starts_with("case,")) continue;
    std::istringstream cells(line);
    std::string id;
    std::getline(cells, id, ',');
    std::vector<double> row;
    for (std::string cell; std::getline(cells, cell, ',') && !cell.empty();) row.push_back(std::stod(cell));
    tables["published/" + id].push_back(adams_figures(row));
  }
  return tables;
}

// RIGOR_DATA/adams, laid out as Project Chrono's data/testing/joints; empty if there is none.
inline std::filesystem::path adams_folder() {
  const char* data = std::getenv("RIGOR_DATA");
  const std::filesystem::path folder = std::filesystem::path(data ? data : "") / "adams";
  return data && std::filesystem::is_directory(folder) ? folder : std::filesystem::path();
}

inline AdamsTable whole_adams_table(const std::filesystem::path& folder, const AdamsCase& of) {
  std::vector<std::vector<double>> rows;
  const auto append = [&](const std::string& what) {
    std::ifstream in(folder / (of.table + "_ADAMS_" + what + ".txt"));
    std::size_t n = 0;
    for (std::string line; std::getline(in, line);) {
      if (!line.starts_with('+')) continue;
      std::istringstream cells(line);
      double time = 0;
      cells >> time;
      if (n == rows.size()) rows.push_back({time});
      for (double cell = 0; cells >> cell;) rows[n].push_back(cell);
      ++n;
    }
  };
  for (const char* what : {"Pos", "Quat"}) append(what);
  for (const char* what : {"Rforce", "Rtorque"}) append(what + of.load);
  if (of.load == "P") append("RforceA");
  AdamsTable table;
  for (const auto& row : rows) table.push_back(adams_figures(row));
  return table;
}

// Half of the last digit of a number as it is printed.
inline double half_digit(double printed, int digits) {
  return printed == 0 ? 0 : 0.5 * std::pow(10, std::floor(std::log10(std::abs(printed))) + 1 - digits);
}

// By how much `found` misses a printed vector beyond its rounding, in its worst component.
inline double beyond_rounding(const Vec3& found, const Vec3& printed, int digits) {
  double most = 0;
  for (int k = 0; k < 3; ++k) most = std::max(most, std::abs(found[k] - printed[k]) - half_digit(printed[k], digits));
  return most;
}

}  // namespace rigor::test
