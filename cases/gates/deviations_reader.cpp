// known_deviations.toml: [[deviation]] tables, read as strictly as a case.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "cases/case/case.h"
#include "cases/case/program_home.h"
#include "cases/gates/deviations.h"
#include "core/base/error.h"
#include "core/base/near_match.h"
#include "core/scene/toml/table_reader.h"

namespace rigor::inline gates {
namespace {

namespace fs = std::filesystem;

Keys metric_names() {
  Keys names;
  for (const MetricRow& row : metrics()) names.push_back(row.name);
  for (const CrossMetricRow& row : cross_metrics()) names.push_back(row.name);
  return names;
}

RunName read_run(const TomlValue& value, const std::string& engine, const std::vector<EngineInfo>& engines) {
  try {
    RunName run = parse_run_name(value.text(), engines);
    if (run.engine == engine) return run;
  } catch (const InputError& error) {
    value.refuse(error.what());
  }
  value.refuse_found(fmt::format("runs of {}, beside whose adapter the file stands", engine));
}

KnownDeviation read_row(const TableReader& table, const std::string& engine, const std::vector<EngineInfo>& engines) {
  KnownDeviation row;
  row.where = table.self().where();
  row.case_id = table.at("case").text();
  row.metric = table.at("gate").choice(metric_names());
  if (const auto runs = table.find("engines")) {
    for (const TomlValue& run : runs->items()) row.runs.push_back(read_run(run, engine, engines));
  } else {
    row.runs.push_back(parse_run_name(engine, engines));
  }
  if (const auto steps = table.find("dt")) {
    for (const TomlValue& step : steps->items()) {
      row.dt.push_back(step.is_text() ? parse_step_size(step.text(), step.label())
                                      : StepSize{step.positive(), fmt::format("{}", step.positive())});
    }
  }
  row.reason = table.at("reason").text();
  return row;
}

}  // namespace

std::vector<KnownDeviation> read_known_deviations(const std::string& adapters_dir,
                                                  const std::vector<EngineInfo>& engines) {
  std::error_code no_matter;
  if (adapters_dir != default_adapters_dir() && !fs::is_directory(adapters_dir, no_matter))
    throw InputError(fmt::format("--deviations {}: there is no such folder", adapters_dir));
  std::vector<KnownDeviation> rows;
  for (const EngineInfo& engine : engines) {
    const fs::path path = fs::path(adapters_dir) / engine.name / "known_deviations.toml";
    std::error_code error;
    if (!fs::exists(path, error)) continue;
    const TomlFile file = TomlFile::read(path.string());
    const auto tables = file.root({"deviation"}).find("deviation");
    if (!tables) continue;
    for (const TableReader& table : tables->tables({"case", "gate", "engines", "dt", "reason"}))
      rows.push_back(read_row(table, engine.name, engines));
  }
  return rows;
}

std::string default_adapters_dir() { return home_folder("adapters", RIGOR_ADAPTERS_DIR); }

}  // namespace rigor::inline gates
