// What a run of the grid came to, in short: the part of results.json that two runs are compared by. A baseline is the
// same as JSON lines, one a cell, so that it is small and its differences can be read.
#pragma once

#include <map>
#include <set>
#include <string>

namespace rigor {

inline constexpr const char* kBetweenValues = " | ";

struct Baseline {
  struct Cell {
    std::string status;                     // "pass", "fail", ...
    std::string verdict;                    // "stable", "gaining", ...; empty if there is none, or it is not known
    std::map<std::string, double> metrics;  // sizes, or infinite; none that is a measured time
    std::set<std::string> not_asked;        // metrics that were not measured because nobody asked for them
  };
  // Keys are made of parts parted by tabs, in this order; no name holds a tab.
  std::map<std::string, Cell> cells;               // case, engine, dt
  std::map<std::string, std::string> gates;        // case, metric, engine, dt (empty for one over several) -> answer
  std::map<std::string, std::string> settings;     // engine, setting -> its values over the cases
  std::set<std::string> left_out;                  // metrics that a cell of a baseline has not where they are rounding
  std::map<std::string, std::string> case_errors;  // case -> why it could not be judged at all
  std::map<std::string, double> durations;         // case -> s; none of an older file
  std::map<std::string, double> stable_steps;      // case, engine -> s, the largest stable step where it was looked for
};

bool is_higher_better(const std::string& metric);  // as its row says

// Of a results.json or of a baseline. Throws InputError, with the line or the place in the JSON, for a file that cannot
// be read, is neither, or holds a status, an answer or a value that there is not.
Baseline read_baseline(const std::string& path);

// Numbers have four digits: what changes less than that is not worth a line in a difference.
std::string baseline_text(const Baseline& baseline);

}  // namespace rigor
