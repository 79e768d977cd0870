#include "cases/import/import.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "adapters/models.h"
#include "cases/import/assembly/assembly.h"
#include "cases/import/memory_limit.h"
#include "cases/import/model_files.h"
#include "cases/import/sdf/sdf_reader.h"
#include "cases/import/urdf_reader.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/near_match.h"
#include "core/scene/contact_laws.h"
#include "core/scene/toml/writing/scene_writer.h"

namespace rigor::inline imports {
namespace {

constexpr std::size_t kMostMemory = std::size_t{900} << 20;  // bytes, beside the program's own

LinkModel read_mjcf(const XmlFile& file, const ImportOptions& options) {
  MjcfSource source = check_files_of_mjcf(file);
  source.keyframe = options.keyframe;
  try {
    return mujoco_link_model(source);
  } catch (const InputError& error) {  // MuJoCo numbers keyframes, and names no line of theirs
    const std::string what = error.what(), start = file.path() + ":1: ";
    const std::size_t key = what.find("key ");
    const auto place = key == std::string::npos ? source.places.end()
                                                : source.places.find(fmt::format("key {}", std::atoi(&what[key + 4])));
    if (place == source.places.end() || !what.starts_with(start)) throw;
    throw InputError(place->second + ": " + what.substr(start.size()));
  }
}

template <LinkModel (*kRead)(const XmlFile&, const ImportOptions&)>
LinkModel read_without_keyframes(const XmlFile& file, const ImportOptions& options) {
  if (!options.keyframe.empty())
    file.root().refuse(
        fmt::format("found no keyframe '{}': a file of this format has none; MJCF has", options.keyframe));
  return kRead(file, options);
}

struct Format {
  std::string root, name;
  LinkModel (*read)(const XmlFile& file, const ImportOptions& options);
};
const std::vector<Format> kFormats = {{"mujoco", "MJCF", read_mjcf},
                                      {"robot", "URDF", read_without_keyframes<read_urdf>},
                                      {"sdf", "SDF", read_without_keyframes<read_sdf>}};

const Format& format_of(const XmlElement& root) {
  std::vector<std::string> names;
  for (const Format& format : kFormats) {
    if (format.root == root.name()) return format;
    names.push_back("<" + format.root + ">");
  }
  root.refuse(fmt::format("found this at the top; allowed: {}", listed(names)));
}

// A line break would end a title.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }, ' ');
  return text;
}

// A fault of the whole model has no line of its own.
Scene scene_of_file(LinkModel& model, const std::string& path, bool with_ground) {
  try {
    return scene_of(model, with_ground);
  } catch (const InputError& error) {
    const std::string what = error.what();
    throw InputError(what.starts_with(path) ? what : path + ":1: " + what);
  }
}

}  // namespace

bool is_model_file(const std::string& path) {
  static const std::vector<std::string> endings = {".urdf", ".sdf", ".mjcf", ".xml", ".xacro"};
  return std::find(endings.begin(), endings.end(), std::filesystem::path(path).extension().string()) != endings.end();
}

Import import_model(const std::string& path, const ImportOptions& options) {
  if (path.ends_with(".xacro"))
    throw InputError(fmt::format("{0}:1: is a macro of xacro; expand it first: xacro {0} > robot.urdf", path));
  return within_memory(kMostMemory, path, [&] {
    const XmlFile file(path);
    const Format& format = format_of(file.root());
    LinkModel model = format.read(file, options);
    Import made;
    made.scene = scene_of_file(model, path, options.ground);
    made.losses = model.left_out.all();
    made.title = one_line(model.name + ", as its " + format.name + " file has it");
    made.source = one_line("imported from " + std::filesystem::path(path).filename().string());
    return made;
  });
}

void refuse_losses(const Import& import, const std::string& path, const ImportOptions& options) {
  const std::vector<Loss> physical = losses_of(import.losses, LossKind::physical);
  if (physical.empty() || options.lossy) return;
  std::string text = fmt::format("{}: this would be another robot; {} of physics would be lost:", path,
                                 physical.size() == 1 ? "1 kind" : fmt::format("{} kinds", physical.size()));
  for (const Loss& loss : physical) text += "\n  " + sentence_of(loss);
  throw InputError(text + "\n  --lossy accepts these losses");
}

std::vector<std::string> lines_of(const std::vector<Loss>& losses) {
  std::vector<std::string> lines;
  for (const auto& [kind, title] : {std::pair{LossKind::physical, "not the same robot; lost physics:"},
                                    {LossKind::assumed, "assumed where the file leaves it open:"}}) {
    const std::vector<Loss> rows = losses_of(losses, kind);
    if (!rows.empty()) lines.emplace_back(title);
    for (const Loss& loss : rows) lines.push_back("  " + sentence_of(loss));
  }
  std::map<std::string, std::size_t> counts;
  for (const Loss& loss : losses_of(losses, LossKind::visual)) counts[loss.what] += loss.count;
  std::string visual;
  for (const auto& [what, count] : counts) visual += fmt::format("{}{} {}", visual.empty() ? "" : ", ", count, what);
  if (!visual.empty()) lines.push_back("left out, without effect on the motion: " + visual);
  return lines;
}

// The truth 'reference' takes no contacts.
std::string truth_of_model(const Scene& scene) { return anything_can_touch(scene) ? "none" : "reference"; }

std::string case_text_of(const Import& import) {
  // JSON's texts are valid in TOML.
  const auto quoted = [](const std::string& text) { return Json(text).dump(); };
  const std::string truth = truth_of_model(import.scene);
  return fmt::format("title = {}\nsource = {}\n\n{}\n[run]\nduration = {}\ndt = [\"{}\"]\n\n[truth]\nkind = \"{}\"{}\n",
                     quoted(import.title), quoted(import.source), scene_toml(import.scene), kModelDuration,
                     fmt::join(kModelSteps, "\", \""), truth,
                     truth == "none" ? "  # \"reference\" takes no contacts" : "");
}

std::string falls_freely(const Scene& scene) {
  const auto stands = [&](int body) { return body == kWorld || scene.bodies[body].fixed; };
  const auto is_ground = [](const Body& body) { return body.fixed && body.collides; };
  if (scene.gravity.isZero(0) || std::any_of(scene.bodies.begin(), scene.bodies.end(), is_ground)) return "";
  std::vector<bool> is_held(scene.bodies.size());
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) is_held[i] = scene.bodies[i].fixed;
  bool changes = true;
  const auto hold = [&](int a, int b) {
    const bool holds_a = stands(a) || is_held[a], holds_b = stands(b) || is_held[b];
    if (holds_a == holds_b) return;
    is_held[holds_a ? b : a] = changes = true;
  };
  while (changes) {  // each pass reaches at least one joint further
    changes = false;
    for (const Joint& joint : scene.joints) hold(joint.a, joint.b);
    for (const Spring& spring : scene.springs) hold(spring.a, spring.b);
  }
  const auto free = std::find(is_held.begin(), is_held.end(), false);
  return free == is_held.end() ? "" : scene.bodies[free - is_held.begin()].name;
}

}  // namespace rigor::inline imports
