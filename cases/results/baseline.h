// The short form of a result: the part of results.json that is compared between two runs. A baseline holds it as JSON
// lines, one per cell, so that it is small and its differences are readable.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

#include "cases/metrics/verdict.h"
#include "cases/results/cell_key.h"
#include "cases/results/results.h"

namespace rigor::inline results {

struct Baseline {
  struct Cell {
    Status status = Status::crashed;
    std::optional<Verdict> verdict = {};         // none if it is unknown
    std::map<std::string, double> metrics = {};  // sizes, or infinite; none that is a measured time
    std::set<std::string> not_asked = {};        // metrics that were not measured because nobody asked for them
  };
  std::map<CellKey, Cell> cells;
  std::map<GateKey, GateAnswer> gates;
  std::map<SettingKey, std::set<std::string>> settings;  // the values over the cases
  std::set<std::string> left_out;                  // metrics that a cell of a baseline has not where they are rounding
  std::map<std::string, std::string> case_errors;  // case -> why it could not be judged at all
  std::map<std::string, double> durations;         // case -> s; empty for an older file
  std::map<RunKey, double> stable_steps;           // s, the largest stable step where it was searched for
};

bool is_higher_better(const std::string& metric);  // as its row says

// Reads a results.json or a baseline. Throws InputError, with the line or the place in the JSON, for an unreadable
// file, another format, or an unknown status, answer or value.
Baseline read_baseline(const std::string& path);

// Numbers have four digits: what changes less than that is not worth a line in a difference.
std::string baseline_text(const Baseline& baseline);

}  // namespace rigor::inline results
