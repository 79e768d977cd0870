#include "cases/results/history.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "cases/results/baseline.h"
#include "cases/results/input_file.h"
#include "cases/results/result_json.h"
#include "cases/results/results.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/json_words.h"

namespace rigor::inline results {
namespace {

constexpr const char* kFormKey = "rigor_history";
constexpr int kHistoryForm = 1;

double finite_to_four(double value) { return std::isfinite(value) ? std::stod(fmt::format("{:.4g}", value)) : value; }

CellKey key_of(const Json& cell) { return {cell.at("case"), cell.at("engine"), cell.at("dt")}; }

Json json_of(const HistoryEntry& entry) {
  Json cells = Json::array();
  for (const auto& [key, cell] : entry.cells) {
    Json row = {{"case", key.case_id},
                {"engine", key.engine},
                {"dt", key.dt},
                {"status", word_of(cell.status)},
                {"metrics", cell.metrics}};
    if (cell.cost) row["cost"] = *cell.cost;
    cells.push_back(std::move(row));
  }
  return {{kFormKey, kHistoryForm},   {"commit", entry.commit},     {"date", entry.date},
          {"machine", entry.machine}, {"versions", entry.versions}, {"cells", cells}};
}

HistoryEntry entry_from(const Json& json) {
  if (json.at(kFormKey) != kHistoryForm) throw InputError(fmt::format("{} is not {}", kFormKey, kHistoryForm));
  HistoryEntry entry;
  entry.commit = json.at("commit").get<std::string>(), entry.date = json.at("date").get<std::string>();
  entry.machine = json.at("machine").get<std::string>();
  if (json.contains("versions")) entry.versions = json.at("versions").get<std::map<std::string, std::string>>();
  for (const Json& row : json.at("cells")) {
    HistoryEntry::Cell cell;
    cell.status = status_of(row.at("status").get<std::string>());
    for (const auto& [name, value] : row.at("metrics").items()) cell.metrics[name] = number_of(value);
    if (row.contains("cost")) cell.cost = number_of(row.at("cost"));
    entry.cells[key_of(row)] = std::move(cell);
  }
  return entry;
}

// What a process leaves that is killed while it writes.
void check_ends_with_a_line(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error) || std::filesystem::file_size(file, error) == 0) return;
  read_history(file);
}

}  // namespace

HistoryEntry history_entry(const std::string& results_file, const std::string& commit, const std::string& date) {
  const Baseline baseline = read_baseline(results_file);
  HistoryEntry entry{commit, date, "", {}, {}};
  for (const auto& [key, cell] : baseline.cells) {
    HistoryEntry::Cell& kept = entry.cells[key];
    kept.status = cell.status;
    for (const auto& [name, value] : cell.metrics) kept.metrics[name] = finite_to_four(value);
  }
  const Json json = parse_json_or_discard(read_input_file(results_file, "a results.json"));
  if (!json.is_object() || !json.contains("machine"))
    throw InputError(fmt::format("{}: is no results.json; a baseline says nothing of its machine", results_file));
  const Json& machine = json.at("machine");
  try {
    entry.machine =
        fmt::format("{}, {} cores, {}, {}", machine.at("cpu").get<std::string>(), machine.at("cores").get<int>(),
                    machine.at("compiler").get<std::string>(), machine.at("build_type").get<std::string>());
    for (const Json& run : json.at("engines")) {
      if (run.contains("version"))
        entry.versions[run.at("name").get<std::string>()] = run.at("version").get<std::string>();
    }
    for (const Json& cell : json.at("cells")) {
      const Json& metrics = cell.at("metrics");
      if (!metrics.contains("cost") || !metrics.at("cost").contains("value")) continue;
      const double cost = number_of(metrics.at("cost").at("value"));
      if (std::isfinite(cost)) entry.cells.at(key_of(cell)).cost = finite_to_four(cost);
    }
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: is no whole results.json: {}", results_file, in_words(error)));
  }
  return entry;
}

void add_to_history(const std::string& file, const HistoryEntry& entry) {
  check_ends_with_a_line(file);
  const std::string line = text_of(json_of(entry), -1) + "\n";
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor < 0) throw InputError(fmt::format("{}: cannot be written: {}", file, std::strerror(errno)));
  const ssize_t written = write(descriptor, line.data(), line.size());
  const int failure = errno;
  close(descriptor);
  if (written != static_cast<ssize_t>(line.size()))
    throw std::runtime_error(fmt::format("{}: was not written whole: {}", file, std::strerror(failure)));
}

std::vector<HistoryEntry> read_history(const std::string& file) {
  const std::string text = read_input_file(file, "a history");
  if (!text.empty() && text.back() != '\n')
    throw InputError(fmt::format("{}: its last line is cut short; take that line away", file));
  std::vector<HistoryEntry> entries;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    try {
      entries.push_back(entry_from(parse_json(line)));
    } catch (const std::exception& error) {
      throw InputError(fmt::format("{}: line {}: is no line of a history: {}", file, number, in_words(error)));
    }
  }
  return entries;
}

}  // namespace rigor::inline results
