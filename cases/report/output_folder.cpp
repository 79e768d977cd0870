#include "cases/report/output_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "core/error.h"

namespace rigor {
namespace {

namespace fs = std::filesystem;
constexpr const char* kPartial = ".partial-";

// What a run that was killed left behind: its number is in the name.
void remove_leftovers(const fs::path& folder) {
  std::error_code no_matter;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, no_matter)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kPartial)) continue;
    const int process = std::atoi(name.c_str() + std::string(kPartial).size());
    const bool is_running = process > 0 && kill(process, 0) == 0;
    if (process > 0 && !is_running) fs::remove_all(entry.path(), no_matter);
  }
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path, const std::vector<std::string>& file_names)
    : folder_(path), partial_(folder_ / fmt::format("{}{}", kPartial, getpid())) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(
        fmt::format("--out {}: cannot be written: {}; give a folder that can be made or written", path, why));
  };
  if (path.empty()) refuse("the name is empty");
  try {
    fs::create_directories(folder_ / "trajectories");
    remove_leftovers(folder_);
    fs::create_directories(partial_ / "trajectories");
  } catch (const fs::filesystem_error& error) {
    refuse(error.code().message());
  }
  for (const std::string& name : file_names) {
    if (fs::exists(folder_ / name) && !fs::is_regular_file(folder_ / name)) {
      fs::remove_all(partial_);
      refuse(fmt::format("'{}' in it is no file", name));
    }
  }
}

OutputFolder::~OutputFolder() {
  std::error_code no_matter;
  fs::remove_all(partial_, no_matter);
}

void OutputFolder::write(const std::string& file_name, const std::string& text) {
  std::ofstream file(partial_ / file_name, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(fmt::format("'{}' could not be written to '{}'", file_name, folder_.string()));
}

void OutputFolder::publish() {
  for (const fs::directory_entry& entry : fs::directory_iterator(partial_ / "trajectories")) {
    fs::rename(entry.path(), folder_ / "trajectories" / entry.path().filename());
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(partial_)) {
    if (entry.is_regular_file()) fs::rename(entry.path(), folder_ / entry.path().filename());
  }
}

}  // namespace rigor
