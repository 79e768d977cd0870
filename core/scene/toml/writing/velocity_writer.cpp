#include "core/scene/toml/writing/velocity_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/scene/toml/body_reader.h"
#include "core/scene/toml/scene_reader.h"
#include "core/scene/toml/table_reader.h"

namespace rigor::inline scene {
namespace {

struct VelocityEdit {
  TextRange where;
  std::string text;
};

std::string written(const Vec3& v) { return fmt::format("[{}, {}, {}]", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0); }

Vec3 as_read(const TableReader& row, std::string_view key) {
  const auto value = row.find(key);
  return value ? value->vector() : Vec3::Zero();
}

// Replaces an existing value, or is inserted after the name, which every body has.
void add_edit(const TableReader& row, const std::string& key, const Vec3& wanted, const std::string& text,
              std::vector<VelocityEdit>& edits) {
  if (as_read(row, key) == wanted) return;
  if (const auto value = row.find(key)) return edits.push_back({value->range(), written(wanted)});
  const std::size_t end = row.at("name").range().end;
  if (row.is_inline()) return edits.push_back({{end, end}, fmt::format(", {} = {}", key, written(wanted))});
  const std::size_t line_end = std::min(text.find('\n', end), text.size());
  edits.push_back({{line_end, line_end}, fmt::format("\n{} = {}", key, written(wanted))});
}

}  // namespace

std::string with_velocities(const TomlFile& file, const TomlValue& scene, const Scene& settled) {
  std::string text = file.text();
  std::vector<VelocityEdit> edits;
  for (const TableReader& row : scene.table(scene_keys()).at("body").tables(body_keys())) {
    const std::string name = row.at("name").text();
    const auto body =
        std::find_if(settled.bodies.begin(), settled.bodies.end(), [&](const Body& b) { return b.name == name; });
    if (body == settled.bodies.end()) continue;  // of an array
    add_edit(row, "velocity", body->velocity, text, edits);
    add_edit(row, "angular_velocity", body->angular_velocity, text, edits);
  }
  std::stable_sort(edits.begin(), edits.end(),
                   [](const VelocityEdit& a, const VelocityEdit& b) { return a.where.begin < b.where.begin; });
  for (auto edit = edits.rbegin(); edit != edits.rend(); ++edit)
    text.replace(edit->where.begin, edit->where.end - edit->where.begin, edit->text);
  return text;
}

}  // namespace rigor::inline scene
