// The short form of a result: the part of results.json that is compared between two runs. A baseline holds it as JSON
// lines, one per cell, so that it is small and its differences are readable.
#pragma once

#include <map>
#include <set>
#include <string>

namespace rigor {

inline constexpr const char* kBetweenValues = " | ";

struct Baseline {
  struct Cell {
    std::string status;                     // "pass", "fail", ...
    std::string verdict;                    // "stable", "gaining", ...; empty if there is none, or it is unknown
    std::map<std::string, double> metrics;  // sizes, or infinite; none that is a measured time
    std::set<std::string> not_asked;        // metrics that were not measured because nobody asked for them
  };
  // Keys are made of parts parted by tabs, in this order; no name holds a tab.
  std::map<std::string, Cell> cells;               // case, engine, dt
  std::map<std::string, std::string> gates;        // case, metric, engine, dt (empty for one over several) -> answer
  std::map<std::string, std::string> settings;     // engine, setting -> its values over the cases
  std::set<std::string> left_out;                  // metrics that a cell of a baseline has not where they are rounding
  std::map<std::string, std::string> case_errors;  // case -> why it could not be judged at all
  std::map<std::string, double> durations;         // case -> s; empty for an older file
  std::map<std::string, double> stable_steps;      // case, engine -> s, the largest stable step where it was looked for
};

bool is_higher_better(const std::string& metric);  // as its row says

// Reads a results.json or a baseline. Throws InputError, with the line or the place in the JSON, for an unreadable
// file, another format, or an unknown status, answer or value.
Baseline read_baseline(const std::string& path);

// Numbers have four digits: what changes less than that is not worth a line in a difference.
std::string baseline_text(const Baseline& baseline);

}  // namespace rigor
