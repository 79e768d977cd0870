#include "cases/import/import.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "adapters/models.h"
#include "cases/import/assembly.h"
#include "cases/import/memory_limit.h"
#include "cases/import/model_files.h"
#include "cases/import/sdf/sdf_reader.h"
#include "cases/import/urdf_reader.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/near_match.h"
#include "core/scene/contact_laws.h"
#include "core/scene/toml/writing/scene_writer.h"

namespace rigor {
namespace {

constexpr const char *kLoss = "# physics: ", *kLeftOut = "# left out: ";
constexpr std::size_t kMostMemory = std::size_t{900} << 20;  // bytes, beside the program's own

LinkModel read_mjcf(const XmlFile& file, const std::string& keyframe) {
  check_files_of_mjcf(file);
  return mujoco_link_model(file.path(), keyframe);
}

template <LinkModel (*kRead)(const XmlFile&)>
LinkModel read_without_keyframes(const XmlFile& file, const std::string& keyframe) {
  if (!keyframe.empty())
    file.root().refuse(fmt::format("found no keyframe '{}': a file of this format has none; MJCF has", keyframe));
  return kRead(file);
}

struct Format {
  std::string root, name;
  LinkModel (*read)(const XmlFile& file, const std::string& keyframe);
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

// The truth 'reference' takes no contacts.
std::string truth_of(const Scene& scene) {
  if (!anything_can_touch(scene)) return "\"reference\"\n";
  return "\"none\"  # bodies may touch; \"reference\" takes scenes in which nothing touches\n";
}

// A line break would end a comment.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }, ' ');
  return text;
}

std::string case_text_of(const LinkModel& model, const Scene& scene, const std::string& format,
                         const std::string& path) {
  // JSON's texts are valid in TOML.
  const auto quoted = [](const std::string& text) { return Json(one_line(text)).dump(); };
  std::string text;
  for (const std::string& sentence : model.left_out.losses()) text += kLoss + one_line(sentence) + "\n";
  for (const std::string& sentence : model.left_out.sentences()) text += kLeftOut + one_line(sentence) + "\n";
  text += fmt::format("title = {}\nsource = {}\n\n", quoted(model.name + ", as its " + format + " file has it"),
                      quoted("imported from " + std::filesystem::path(path).filename().string()));
  text += scene_toml(scene);
  return text + fmt::format("\n[run]\nduration = 2\ndt = [\"1/30\", \"1/240\", \"1/1000\"]\n\n[truth]\nkind = {}",
                            truth_of(scene));
}

// A fault of the whole model has no line of its own.
Scene scene_of_file(LinkModel& model, const std::string& path) {
  try {
    return scene_of(model);
  } catch (const InputError& error) {
    const std::string what = error.what();
    throw InputError(what.starts_with(path) ? what : path + ":1: " + what);
  }
}

}  // namespace

bool is_model_file(const std::string& path) {
  static const std::vector<std::string> endings = {".urdf", ".sdf", ".mjcf", ".xml"};
  return std::find(endings.begin(), endings.end(), std::filesystem::path(path).extension().string()) != endings.end();
}

Import import_model(const std::string& path, const std::string& keyframe) {
  return within_memory(kMostMemory, path, [&] {
    const XmlFile file(path);
    const Format& format = format_of(file.root());
    LinkModel model = format.read(file, keyframe);
    const Scene scene = scene_of_file(model, path);
    return Import{case_text_of(model, scene, format.name, path), model.left_out.losses(), model.left_out.sentences()};
  });
}

std::vector<std::string> losses_of(const std::string& case_text) {
  const std::string start = kLoss;
  std::vector<std::string> lines;
  for (std::size_t at = 0; case_text.compare(at, start.size(), start) == 0;) {
    const std::size_t end = case_text.find('\n', at);
    lines.push_back(case_text.substr(at + start.size(), end - at - start.size()));
    at = end + 1;
  }
  return lines;
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

}  // namespace rigor
