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
#include "core/scene/toml/scene_writer.h"

namespace rigor {
namespace {

constexpr const char* kLeftOut = "# left out: ";
constexpr std::size_t kMostMemory = std::size_t{900} << 20;  // bytes, beside what the program has already

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

// The truth of joints reaches no further than where bodies touch.
std::string truth_of(const Scene& scene) {
  if (!anything_can_touch(scene)) return "\"reference\"\n";
  return "\"none\"  # bodies may touch, and no truth of joints goes beyond that; with collides = false, "
         "\"reference\"\n";
}

// What stands in a comment must not end it.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }, ' ');
  return text;
}

std::string case_text_of(const LinkModel& model, const Scene& scene, const std::string& format,
                         const std::string& path) {
  // TOML's texts are JSON's.
  const auto quoted = [](const std::string& text) { return Json(one_line(text)).dump(); };
  std::string text;
  for (const std::string& sentence : model.left_out.sentences()) text += kLeftOut + one_line(sentence) + "\n";
  text += fmt::format("title = {}\nsource = {}\n\n", quoted(model.name + ", as its " + format + " file has it"),
                      quoted("imported from " + std::filesystem::path(path).filename().string()));
  text += scene_toml(scene);
  return text + fmt::format("\n[run]\nduration = 2\ndt = [\"1/30\", \"1/240\", \"1/1000\"]\n\n[truth]\nkind = {}",
                            truth_of(scene));
}

// What only the whole shows is of no line.
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
    return Import{case_text_of(model, scene, format.name, path), model.left_out.sentences()};
  });
}

std::vector<std::string> left_out_of(const std::string& case_text) {
  const std::string start = kLeftOut;
  std::vector<std::string> lines;
  for (std::size_t at = 0; case_text.compare(at, start.size(), start) == 0;) {
    const std::size_t end = case_text.find('\n', at);
    lines.push_back(case_text.substr(at + start.size(), end - at - start.size()));
    at = end + 1;
  }
  return lines;
}

}  // namespace rigor
