#include "cases/case/family.h"

#include <algorithm>
#include <filesystem>

#include "cases/case/run_selector.h"
#include "cases/case/selection.h"
#include "core/scene/features/features.h"

namespace rigor::inline cases {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kExtension = ".toml";

// The words of the scene's features. "gravity" and "damping" (of a spring) are properties, not features.
Keys words_of(const Scene& scene) {
  Keys words;
  for (const Need& need : needs_of(scene)) words.push_back(word_of(need.feature));
  if (scene.gravity.norm() > 0) words.push_back("gravity");
  const auto damps = [](const Spring& spring) { return spring.damping > 0; };
  if (std::any_of(scene.springs.begin(), scene.springs.end(), damps)) words.push_back("damping");
  return words;
}

// "contact" stands for any "contact:...".
bool has(const Keys& words, const std::string& wanted) {
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& word) { return word == wanted || word.starts_with(wanted + ":"); });
}

// The names of the other files of the folder, which no family lists.
Keys cases_beside(const std::string& path) {
  Keys names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(fs::path(path).parent_path(), error)) {
    const fs::path& file = entry.path();
    if (file.extension() == kExtension && file.filename() != kFamilyFile) names.push_back(file.stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool is_about(const GateTable& table, const Case& definition, const Keys& scene_words) {
  std::string name = definition.id.substr(definition.id.rfind('/') + 1);  // an id, or the path of a file elsewhere
  if (name.ends_with(kExtension)) name.resize(name.size() - kExtension.size());
  if (std::find(table.except.begin(), table.except.end(), name) != table.except.end()) return false;
  const bool has_scene = std::all_of(table.scene.begin(), table.scene.end(), [&](const std::string& word) {
    return word.starts_with('!') ? !has(scene_words, word.substr(1)) : has(scene_words, word);
  });
  const bool has_truth = table.truths.empty() ||
                         std::find(table.truths.begin(), table.truths.end(), definition.truth) != table.truths.end();
  return has_scene && has_truth;
}

bool is_instead_of(const Gate& own, const Gate& of_family) {
  if (own.metric != of_family.metric) return false;
  if (own.limit.index() != of_family.limit.index()) return false;
  if (const RankingLimit* ranking = own.ranking()) return ranking->better_than == of_family.ranking()->better_than;
  return !std::holds_alternative<BoundLimit>(own.limit);
}

// False if no run is left.
bool leave_out_runs_of(const std::vector<Gate>& own, const std::vector<EngineInfo>& infos, Gate& gate) {
  for (const Gate& special : own) {
    if (!is_instead_of(special, gate)) continue;
    if (special.engines.empty()) return false;
    if (gate.engines.empty()) {
      for (const RunName& run : default_runs(infos)) gate.engines.push_back(run.text);
    }
    const GateSelection specials(special, infos);
    std::erase_if(gate.engines, [&](const std::string& name) { return specials.takes(parse_run_name(name, infos)); });
    if (gate.engines.empty()) return false;
  }
  return true;
}

}  // namespace

Family read_family(const std::string& path, const Vocabulary& words) {
  const TomlFile file = TomlFile::read(path);
  Family family;
  const Keys cases = cases_beside(path);
  for (const TableReader& table : file.root({"gate"}).at("gate").tables(family_gate_keys()))
    family.gates.push_back(read_family_gate_table(table, cases, words));
  return family;
}

void add_family_gates(const Family& family, const Vocabulary& words, Case& definition) {
  const std::vector<Gate> own = definition.gates;
  const Keys scene_words = words_of(definition.scene);
  for (const GateTable& table : family.gates) {
    const auto steps = selected_steps(table.steps, definition.dt);
    const std::size_t least = table.gate.order() ? 2 : 1;
    if (!is_about(table, definition, scene_words) || steps.size() < least) continue;
    for (const std::string& metric : table.metrics) {
      Gate gate = table.gate;
      gate.metric = metric;
      if (!table.steps.empty()) gate.dt = steps;
      if (leave_out_runs_of(own, words.engines, gate)) definition.gates.push_back(gate);
    }
  }
}

}  // namespace rigor::inline cases
