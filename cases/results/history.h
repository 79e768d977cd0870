// A history: results from commit to commit, one JSON object per line. Lines are only added.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cases/results/cell_key.h"
#include "cases/results/results.h"

namespace rigor::inline results {

struct HistoryEntry {
  std::string commit, date, machine;  // the date as 2026-01-31T12:00:00Z
  struct Cell {
    Status status = Status::crashed;
    std::map<std::string, double> metrics;  // as in a baseline: four digits, not finite where the run had no number
    std::optional<double> cost;             // s/s
  };
  std::map<CellKey, Cell> cells;
  std::map<std::string, std::string> versions = {};  // of the engine, by run; empty in lines of Rigor 1.0
};

// Reads a results.json. Throws InputError for any other file.
HistoryEntry history_entry(const std::string& results_file, const std::string& commit, const std::string& date);

// Adds a line in one write. Throws InputError if the file is no history or cannot be written.
void add_to_history(const std::string& file, const HistoryEntry& entry);

// Throws InputError, with the line, for a file that cannot be read or is no history.
std::vector<HistoryEntry> read_history(const std::string& file);

}  // namespace rigor::inline results
