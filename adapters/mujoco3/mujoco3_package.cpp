#include "adapters/mujoco3/mujoco3_package.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "core/base/error.h"
#include "core/base/json.h"

namespace rigor::inline adapters {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPackage = "node_modules/@mujoco/mujoco/package.json";

bool is_file(const fs::path& path) {
  std::error_code none;
  return fs::is_regular_file(path, none);
}

bool has_node() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (access((fs::path(folder) / "node").c_str(), X_OK) == 0) return true;
  }
  return false;
}

// In a build, or installed.
fs::path folder_of_script() {
  std::error_code error;
  const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path(), beside = here / "mujoco3";
  return is_file(beside / "mujoco3.mjs") ? beside : here.parent_path() / "libexec" / "rigor" / "mujoco3";
}

}  // namespace

std::string mujoco3_package_folder() {
  if (!has_node() || !is_file(mujoco3_script())) return "";
  const char* named = std::getenv("RIGOR_MUJOCO3");
  for (const fs::path& folder : {fs::path(named ? named : ""), folder_of_script()}) {
    std::error_code error;
    if (!folder.empty() && is_file(folder / kPackage)) return fs::absolute(folder, error).string();
  }
  return "";
}

std::string mujoco3_version(const std::string& folder) {
  const fs::path path = fs::path(folder) / kPackage;
  std::ifstream file(path);
  const Json package = parse_json_or_discard(std::string(std::istreambuf_iterator<char>(file), {}));
  const auto version = package.find("version");
  if (version == package.end() || !version->is_string())
    throw InputError(fmt::format("{}: it does not name the package's version; install it again", path.string()));
  return version->get<std::string>();
}

std::string mujoco3_script() { return (folder_of_script() / "mujoco3.mjs").string(); }

}  // namespace rigor::inline adapters
