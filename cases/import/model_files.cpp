#include "cases/import/model_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "core/base/error.h"

namespace rigor::inline imports {
namespace {

namespace fs = std::filesystem;

bool is_inside(const fs::path& path, const fs::path& folder) {
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end();
}

fs::path folder_of(const std::string& model) {
  std::error_code error;
  const fs::path folder = fs::path(model).parent_path();
  return fs::weakly_canonical(folder.empty() ? "." : folder, error);
}

// MuJoCo opens the paths in `file` and in the six faces of a texture.
bool names_a_file(const std::string& attribute) { return attribute.starts_with("file"); }
bool names_a_folder(const std::string& attribute) {
  return attribute == "meshdir" || attribute == "texturedir" || attribute == "assetdir";
}

class MjcfFiles {
 public:
  explicit MjcfFiles(const std::string& model) : model_(model) {}

  void read(const XmlFile& file) {
    size_ += file.size();
    if (size_ > kLargestModel)
      throw InputError(fmt::format("{}:1: with it the model is larger than {} MiB, the largest that is read",
                                   file.path(), kLargestModel >> 20));
    collect(file);
  }

  // Runs when all folders that may hold a file are known.
  void check_assets() {
    for (const auto& [where, element, path] : assets_) {
      for (const std::string& folder : folders_) check(where, element, folder.empty() ? path : folder + "/" + path);
    }
  }

  MjcfSource source() && {
    MjcfSource all{model_, "", {}, std::move(places_)};
    all.files.assign(files_.begin(), files_.end());
    return all;
  }

 private:
  struct Asset {
    std::string where, element, path;
  };

  void collect(const XmlFile& file) {
    std::vector<std::pair<XmlElement, std::string>> waiting = {{file.root(), ""}};
    while (!waiting.empty()) {
      const auto [element, section] = waiting.back();
      waiting.pop_back();
      keep_place(element, section);
      for (const auto& [attribute, value] : element.attributes()) {
        if (names_a_file(attribute) || names_a_folder(attribute)) check_stays_in_folder(value, element, model_);
        if (names_a_folder(attribute)) folders_.insert(value);
        if (names_a_file(attribute)) assets_.push_back({element.where(), element.name(), value});
        if (names_a_file(attribute) && element.name() == "include") include(value, element);
      }
      static const std::set<std::string> kSections = {"actuator", "equality", "tendon"};
      const std::string below = kSections.contains(element.name()) ? element.name() : section;
      const std::vector<XmlElement> children = element.children();
      for (auto child = children.rbegin(); child != children.rend(); ++child) waiting.emplace_back(*child, below);
    }
  }

  // MuJoCo knows an element by its name and its kind: "joint/elbow", "actuator/knee".
  void keep_place(const XmlElement& element, const std::string& section) {
    if (element.name() == "key") places_.emplace(fmt::format("key {}", keys_++), element.where());
    const auto name = element.find("name");
    if (!name) return;
    const std::string word = element.name() == "freejoint" ? "joint" : element.name();
    places_.emplace((section.empty() ? word : section) + "/" + *name, element.where());
  }

  // MuJoCo itself refuses a file that is included twice.
  void include(const std::string& path, const XmlElement& element) {
    const fs::path file = folder_of(model_) / path;
    if (!included_.insert(file.lexically_normal().string()).second)
      element.refuse(fmt::format("'{}' is included twice", path));
    read(XmlFile(file.string()));
  }

  void check(const std::string& where, const std::string& element, const std::string& path) {
    std::error_code error;
    const fs::path folder = folder_of(model_), file = fs::weakly_canonical(folder / path, error);
    if (error || !is_inside(file, folder))
      throw InputError(fmt::format("{}: <{}>: '{}' leaves the folder of the model", where, element, path));
    const auto status = fs::status(file, error);
    if (!fs::exists(status)) return;  // MuJoCo reports it
    if (!fs::is_regular_file(status) || fs::file_size(file, error) > kLargestModel)
      throw InputError(fmt::format("{}: <{}>: '{}' is no regular file of at most {} MiB", where, element, path,
                                   kLargestModel >> 20));
    files_.insert(path);
  }

  std::string model_;
  std::size_t size_ = 0, keys_ = 0;
  std::vector<Asset> assets_;
  std::set<std::string> folders_ = {""}, included_, files_;
  std::map<std::string, std::string> places_;
};

}  // namespace

void check_stays_in_folder(const std::string& path, const XmlElement& element, const std::string& model) {
  for (const char* of_packages : {"package://", "model://"}) {
    if (path.starts_with(of_packages)) return;
  }
  const fs::path folder = folder_of(model), given = path;
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(folder / given, error);
  if (given.is_absolute() || path.find("://") != std::string::npos || path.find('\\') != std::string::npos || error ||
      !is_inside(whole, folder))
    element.refuse(
        fmt::format("'{}' leaves the folder of the model; allowed: a path inside it, package:// or model://", path));
}

std::optional<std::string> file_of_mesh(const std::string& path, const XmlElement& element, const std::string& model) {
  check_stays_in_folder(path, element, model);
  fs::path folder = folder_of(model), rest = path;
  for (const std::string scheme : {"package://", "model://"}) {
    if (!path.starts_with(scheme)) continue;
    const std::size_t slash = path.find('/', scheme.size());
    const std::string package = path.substr(scheme.size(), slash - scheme.size());
    if (slash == std::string::npos || package.empty()) return {};
    while (folder.filename() != package && folder.has_relative_path()) folder = folder.parent_path();
    if (folder.filename() != package) return {};
    rest = path.substr(slash + 1);
  }
  std::error_code error;
  const fs::path file = fs::weakly_canonical(folder / rest, error);
  if (error || rest.is_absolute() || !is_inside(file, folder))
    element.refuse(fmt::format("'{}' leaves the folder of its package", path));
  if (!fs::is_regular_file(file, error)) element.refuse(fmt::format("there is no file '{}'", path));
  return file.string();
}

MjcfSource check_files_of_mjcf(const XmlFile& model) {
  MjcfFiles files(model.path());
  files.read(model);
  files.check_assets();
  return std::move(files).source();
}

}  // namespace rigor::inline imports
