#include "core/scene/toml/time_table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/base/error.h"
#include "core/base/near_match.h"
#include "core/scene/shapes/mesh_file.h"
#include "core/scene/toml/file_reader.h"

namespace rigor::inline scene {
namespace {

TimeTable table_of_rows(const TomlValue& value) {
  TimeTable table;
  for (const TomlValue& row : value.items()) {
    const std::vector<double> pair = row.numbers({2});
    if (!table.times.empty() && !(pair[0] > table.times.back()))
      row.refuse(fmt::format("found the time {} after {}; allowed: times that rise", pair[0], table.times.back()));
    table.times.push_back(pair[0]), table.values.push_back(pair[1]);
  }
  return table;
}

std::string path_of(const TomlValue& file) {
  try {
    return path_beside(file.path(), file.text());
  } catch (const InputError& error) {
    file.refuse(shown(error.what(), 400));
  }
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    std::string_view cell = line.substr(0, comma);
    while (!cell.empty() && (cell.front() == ' ' || cell.front() == '\t')) cell.remove_prefix(1);
    while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\t' || cell.back() == '\r')) cell.remove_suffix(1);
    cells.push_back(cell);
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

// The column `wanted` of a text of comma-separated values, of which the first column is the time.
class CsvColumn {
 public:
  CsvColumn(std::string text, std::string path) : text_(std::move(text)), path_(std::move(path)) {}

  TimeTable read(const TomlValue& wanted) {
    std::string_view left = text_;
    if (left.starts_with("\xef\xbb\xbf")) left.remove_prefix(3);
    const std::size_t column = find(wanted, cells_of(next_line(left)));
    TimeTable table;
    while (!left.empty()) {
      const std::string_view line = next_line(left);
      const std::vector<std::string_view> cells = cells_of(line);
      if (cells.size() == 1 && cells[0].empty()) continue;
      const double time = number(line, cells, 0);
      if (!table.times.empty() && !(time > table.times.back()))
        refuse(1, fmt::format("found the time {} after {}; allowed: times that rise", time, table.times.back()));
      table.times.push_back(time), table.values.push_back(number(line, cells, column));
    }
    if (table.times.empty()) refuse(1, "there is no row below the header; allowed: at least one");
    return table;
  }

 private:
  std::string_view next_line(std::string_view& left) {
    const std::size_t end = left.find('\n');
    const std::string_view line = left.substr(0, end);
    left.remove_prefix(end == std::string_view::npos ? left.size() : end + 1);
    ++line_;
    return line;
  }

  std::size_t find(const TomlValue& wanted, const std::vector<std::string_view>& names) const {
    if (names[0] != "time") refuse(1, fmt::format("the first column is '{}'; allowed: time", shown(names[0])));
    const std::string name = wanted.text();
    const auto found = std::find(names.begin() + 1, names.end(), name);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    const std::vector<std::string> others(names.begin() + 1, names.end());
    wanted.refuse(fmt::format("{} has no column '{}'{}; there is: {}", path_, shown(name), did_you_mean(name, others),
                              others.empty() ? "time alone" : shown(listed(others), 400)));
  }

  double number(std::string_view line, const std::vector<std::string_view>& cells, std::size_t column) const {
    if (column >= cells.size())
      refuse(line.size() + 1, fmt::format("found {} columns; allowed: at least {}", cells.size(), column + 1));
    const std::string_view cell = cells[column];
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error == std::errc() && end == cell.data() + cell.size() && std::isfinite(value)) return value;
    refuse(static_cast<std::size_t>(cell.data() - line.data()) + 1,
           fmt::format("found '{}'; allowed: a finite number", shown(cell)));
  }

  [[noreturn]] void refuse(std::size_t at, const std::string& fault) const {
    throw InputError(fmt::format("{}:{}:{}: {}", path_, line_, at, fault));
  }

  std::string text_, path_;
  std::size_t line_ = 0;
};

}  // namespace

std::optional<TimeTable> read_effort_or_target(const TableReader& row, const std::string& key) {
  const auto inline_value = row.find(key), file = row.find("file"), column = row.find("column");
  if (inline_value && file) file->refuse(fmt::format("gives {} a second time; allowed: one of the two", key));
  if (column && !file) column->refuse("names a column of no file; allowed: file, too");
  if (!inline_value && !file) return refuse_table_keys(row, key + " is missing"), std::nullopt;
  if (inline_value && !inline_value->is_array()) {
    refuse_table_keys(row, key + " is a number");
    return TimeTable::constant(inline_value->number());
  }
  TimeTable table;
  if (inline_value) {
    table = table_of_rows(*inline_value);
  } else {
    const std::string path = path_of(*file);
    table = CsvColumn(read_text_file(path), path).read(row.at("column"));
  }
  if (const auto way = row.find("interpolate")) table.is_linear = way->choice({"linear", "previous"}) == "linear";
  return table;
}

void refuse_table_keys(const TableReader& row, const std::string& why) {
  for (const char* key : {"file", "column", "interpolate"}) {
    if (const auto value = row.find(key)) value->refuse(why + "; allowed: no such key");
  }
}

}  // namespace rigor::inline scene
