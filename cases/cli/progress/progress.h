// Shows on stderr how far a command is: a bar on a terminal, else a line every ten seconds.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "cases/cli/progress/time_left.h"

namespace rigor::inline cli {

class Progress {
 public:
  // `what`: the noun of the count, as "cells".
  explicit Progress(std::string what = "cells");
  ~Progress();  // wipes the bar
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void show(std::size_t done, std::size_t all);  // `all` is 0 if it is not known
  // What the lines say of the time left, after so many seconds. Without it the rate so far says it.
  using Left = std::function<std::optional<Estimate>(double seconds)>;
  void estimate_with(Left left) { left_ = std::move(left); }

 private:
  void show_bar() const;
  void print_line_if_due();

  std::string what_;
  bool is_terminal_, has_colour_;
  std::size_t done_ = 0, all_ = 0, kept_ = 0;
  std::chrono::steady_clock::time_point start_, last_line_;
  Left left_;
};

// "37 of 140 cells after 42 s; 2 to 4 minutes left". The lower bound is the remaining time at the rate so far.
// `kept`: of `done`, those that an interrupted run had finished.
std::string progress_text(const std::string& what, std::size_t done, std::size_t all, double seconds,
                          std::size_t kept = 0);
// "37 of 140 cells after 42 s; 2 to 4 minutes left", or "; the time left is not known yet".
std::string progress_text(const std::string& what, std::size_t done, std::size_t all, double seconds,
                          const std::optional<Estimate>& left);

}  // namespace rigor::inline cli
