#include "cases/runner/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <set>
#include <stdexcept>

#include "core/base/error.h"

namespace rigor {
namespace {

namespace fs = std::filesystem;
constexpr const char* kPartial = ".partial-";

// What runs that were killed left behind: their number is in the name.
std::vector<fs::path> leftovers(const fs::path& folder) {
  std::error_code no_matter;
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, no_matter)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kPartial)) continue;
    const int process = std::atoi(name.c_str() + std::string(kPartial).size());
    const bool is_running = process > 0 && kill(process, 0) == 0;
    if (process > 0 && !is_running) found.push_back(entry.path());
  }
  return found;
}

// The latest of them becomes `partial`; the others go.
void take_over(std::vector<fs::path> left, const fs::path& partial, bool resume) {
  std::error_code no_matter;
  std::sort(left.begin(), left.end(), [&](const fs::path& a, const fs::path& b) {
    return fs::last_write_time(a, no_matter) < fs::last_write_time(b, no_matter);
  });
  if (resume && !left.empty()) {
    fs::rename(left.back(), partial, no_matter);
    if (!no_matter) left.pop_back();
  }
  for (const fs::path& path : left) fs::remove_all(path, no_matter);
}

// case--engine--dt.csv, as the grid names them.
bool is_trajectory(const fs::path& path) {
  const std::string name = path.filename().string();
  const std::size_t first = name.find("--");
  return path.extension() == ".csv" && first != std::string::npos && name.find("--", first + 2) != std::string::npos;
}

// Both names exist, and at no time does either not; where the file system cannot do that, one after the other.
void exchange(const fs::path& one, const fs::path& other) {
  if (renameat2(AT_FDCWD, one.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE) == 0) return;
  const fs::path aside = one.string() + ".old";
  fs::rename(other, aside), fs::rename(one, other), fs::rename(aside, one);
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path, const std::vector<std::string>& file_names, bool resume)
    : folder_(path), partial_(folder_ / fmt::format("{}{}", kPartial, getpid())) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(
        fmt::format("--out {}: cannot be written: {}; give a folder that can be made or written", path, why));
  };
  if (path.empty()) refuse("the name is empty");
  try {
    fs::create_directories(folder_ / "trajectories");
    take_over(leftovers(folder_), partial_, resume);
    fs::create_directories(partial_ / "trajectories");
    fs::create_directories(partial_ / "journals");
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
  if (!is_kept_) fs::remove_all(partial_, no_matter);
}

void OutputFolder::write(const std::string& file_name, const std::string& text) {
  std::ofstream file(partial_ / file_name, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(fmt::format("'{}' could not be written to '{}'", file_name, folder_.string()));
}

void OutputFolder::rename_into_place() const {
  exchange(partial_ / "trajectories", folder_ / "trajectories");
  for (const fs::directory_entry& entry : fs::directory_iterator(partial_)) {
    if (entry.is_regular_file()) fs::rename(entry.path(), folder_ / entry.path().filename());
  }
}

void OutputFolder::publish(const std::vector<std::string>& trajectories) {
  const std::set<std::string> wanted(trajectories.begin(), trajectories.end());
  for (const fs::directory_entry& entry : fs::directory_iterator(partial_ / "trajectories")) {
    if (!wanted.contains(entry.path().filename().string())) fs::remove_all(entry.path());
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "trajectories")) {
    const fs::path there = partial_ / "trajectories" / entry.path().filename();
    if (!is_trajectory(entry.path()) && !fs::exists(there))
      fs::copy(entry.path(), there, fs::copy_options::recursive | fs::copy_options::copy_symlinks);
  }
  // A process of its own, in a session of its own, so that whoever kills this one does not stop it half-way.
  const pid_t child = fork();
  if (child == 0) {
    setsid();
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
    try {
      rename_into_place();
      _exit(0);
    } catch (const std::exception&) {
      _exit(1);
    }
  }
  int status = 1;
  if (child > 0) waitpid(child, &status, 0);
  if (child < 0) rename_into_place();
  if (child > 0 && status != 0)
    throw std::runtime_error(fmt::format("the outputs could not be renamed into '{}'", folder_.string()));
}

}  // namespace rigor
