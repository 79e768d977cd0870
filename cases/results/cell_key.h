// Keys of results by name: a cell of the grid, a gate's answer, a run of a case, a setting of a run.
#pragma once

#include <compare>
#include <initializer_list>
#include <string>

namespace rigor::inline results {

// The parts that are not empty, in order.
std::string joined_parts(std::initializer_list<std::string> parts, const std::string& between);

struct CellKey {
  std::string case_id, engine, dt;  // the name of the run; dt as written

  auto operator<=>(const CellKey&) const = default;
  std::string text(const std::string& between = ", ") const { return joined_parts({case_id, engine, dt}, between); }
};

struct GateKey {
  std::string case_id, metric, engine, dt;  // dt is empty for a gate over several steps

  auto operator<=>(const GateKey&) const = default;
  std::string text() const { return joined_parts({case_id, metric, engine, dt}, ", "); }
};

struct RunKey {
  std::string case_id, engine;

  auto operator<=>(const RunKey&) const = default;
  std::string text() const { return joined_parts({case_id, engine}, ", "); }
};

struct SettingKey {
  std::string engine, setting;

  auto operator<=>(const SettingKey&) const = default;
  std::string text() const { return joined_parts({engine, setting}, ", "); }
};

}  // namespace rigor::inline results
