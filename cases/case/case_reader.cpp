#include "cases/case/case_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "cases/case/gate_reader.h"
#include "cases/case/seconds_reader.h"
#include "cases/truth/truth.h"
#include "core/scene/toml/scene_reader.h"
#include "core/scene/toml/table_reader.h"

namespace rigor {
namespace {

template <typename Rows>
Keys names_of(const Rows& rows) {
  Keys names;
  for (const auto& row : rows) names.push_back(row.name);
  return names;
}

void read_run(const TableReader& table, Case& out) {
  out.duration = read_seconds(table.at("duration")).seconds;
  for (const TomlValue& value : table.at("dt").items()) {
    const StepSize dt = read_seconds(value);
    check_step_size(dt, out.duration, value.label());
    const auto same = [&](const StepSize& other) { return other.seconds == dt.seconds; };
    if (std::any_of(out.dt.begin(), out.dt.end(), same))
      value.refuse(fmt::format("the step {} s is given twice", dt.text));
    out.dt.push_back(dt);
  }
}

void read_truth(const TableReader& table, Case& out) {
  Keys known = names_of(truths());
  known.push_back("none");
  const TomlValue kind = table.at("kind");
  out.truth = kind.choice(known);
  out.truth_where = kind.where();
}

}  // namespace

Case read_case(const std::string& path, const std::string& id) {
  const TomlFile file = TomlFile::read(path);
  const TableReader root = file.root({"title", "source", "scene", "run", "truth", "gate"});
  Case out;
  out.id = id;
  out.text = file.text();
  out.title = root.at("title").text();
  if (const auto source = root.find("source")) out.source = source->text();
  out.scene = read_scene(root.at("scene"));
  read_run(root.at("run").table({"duration", "dt"}), out);
  if (const auto truth = root.find("truth")) read_truth(truth->table({"kind"}), out);
  if (const auto gates = root.find("gate")) {
    for (const TableReader& table : gates->tables(gate_keys())) {
      for (Gate& gate : gates_of(read_gate_table(table), out)) out.gates.push_back(std::move(gate));
    }
  }
  return out;
}

}  // namespace rigor
