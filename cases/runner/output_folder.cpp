// Inside the hidden folder:
//   lock           held by flock while a process of the run lives, in any container
//   journals/ trajectories/   of this run only; published files are links to them
//   staged/        the files to move into place, and `ready` once they are complete
#include "cases/runner/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "cases/runner/platform/platform.h"
#include "core/base/error.h"

namespace rigor::inline runner {
namespace {

namespace fs = std::filesystem;
constexpr const char *kPartial = ".rigor-partial", *kTrajectories = "trajectories", *kReady = "ready";

[[noreturn]] void fail(int number, const fs::path& path) {
  throw fs::filesystem_error("", path, std::error_code(number, std::generic_category()));
}

constexpr ino_t kNoInode = static_cast<ino_t>(-1);  // for an empty path, and for one that does not exist

// The lock's descriptor; none if another run holds it. A lock file that its holder has removed meanwhile locks nothing.
std::optional<int> try_to_lock(const fs::path& partial) {
  Platform& platform = the_platform();
  const fs::path file = partial / "lock";
  for (;;) {
    platform.make_folders(partial);
    const int lock = platform.open(file, O_RDWR | O_CREAT);
    if (lock < 0 && errno == ENOENT) continue;
    if (lock < 0) fail(errno, file);
    const int failure = platform.lock(lock) == 0 ? 0 : errno;
    if (failure == 0 && platform.inode(lock) == platform.inode(file)) return lock;
    platform.close(lock);
    if (failure == EWOULDBLOCK) return {};
    if (failure != 0) fail(failure, file);
  }
}

// A run that was killed an instant ago may still have children, or be putting its outputs into place.
std::optional<int> lock_within_seconds(const fs::path& partial) {
  constexpr int kTries = 100;
  for (int i = 0; i < kTries; ++i) {
    if (const auto lock = try_to_lock(partial)) return lock;
    the_platform().sleep(std::chrono::milliseconds(20));
  }
  return {};
}

// case--engine--dt.csv, as the grid names them.
bool is_trajectory(const fs::path& path) {
  const std::string name = path.filename().string();
  const std::size_t first = name.find("--");
  return path.extension() == ".csv" && first != std::string::npos && name.find("--", first + 2) != std::string::npos;
}

// At no time is there no folder of trajectories; where the file system cannot exchange two, one goes before the other
// comes.
void exchange(const fs::path& fresh, const fs::path& old) {
  Platform& platform = the_platform();
  if (platform.exchange(fresh, old)) return;
  if (platform.exists(old)) platform.rename(old, fresh.string() + ".old");
  platform.rename(fresh, old);
}

// Every step here may be interrupted and repeated by another process. A file in place is no longer staged. The inode in
// `ready` distinguishes the staged folder of trajectories from the one that it replaced.
void put_into_place(const fs::path& staged, const fs::path& folder) {
  Platform& platform = the_platform();
  const ReadFile read = read_file(staged / kReady);
  std::istringstream ready(read.bytes);
  ino_t fresh = 0;
  std::vector<std::string> not_written;
  ready >> fresh;
  for (std::string name; ready >> name;) not_written.push_back(name);
  if (!read.is_whole) throw std::runtime_error("what is ready could not be read");
  if (platform.inode(staged / kTrajectories) == fresh) exchange(staged / kTrajectories, folder / kTrajectories);
  for (const fs::path& file : platform.entries(staged / "reports")) platform.rename(file, folder / file.filename());
  for (const std::string& name : not_written) platform.remove(folder / name);
  platform.remove(staged / kReady);
}

// Publishes in a separate process, so that killing this one does not interrupt it. If that process fails or is killed,
// this one continues from there.
void put_into_place_unstopped(const fs::path& staged, const fs::path& folder) {
  if (the_platform().do_unstopped([&] { put_into_place(staged, folder); }) || !the_platform().exists(staged / kReady))
    return;
  try {
    put_into_place(staged, folder);
  } catch (const std::exception& error) {
    throw std::runtime_error(
        fmt::format("the outputs could not be put into '{}' as a whole: {}; the next run there begins by that",
                    folder.string(), error.what()));
  }
}

void check_what_stands_there(const fs::path& folder, const std::vector<std::string>& file_names) {
  for (const std::string& name : file_names) {
    if (the_platform().exists(folder / name) && !the_platform().is_file(folder / name))
      throw InputError(fmt::format("'{}' in it is no file", name));
  }
  for (const char* name : {kTrajectories, kPartial}) {
    if (the_platform().exists(folder / name) && !the_platform().is_folder(folder / name))
      throw InputError(fmt::format("'{}' in it is no folder", name));
  }
}

void clear_all_but(const fs::path& folder, const std::set<std::string>& names) {
  for (const fs::path& entry : the_platform().entries(folder)) {
    if (!names.contains(entry.filename().string())) the_platform().remove_all(entry);
  }
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path, const std::vector<std::string>& file_names, bool resume)
    : folder_(path), partial_(folder_ / kPartial), staged_(partial_ / "staged"), file_names_(file_names) {
  try {
    if (path.empty()) throw InputError("the name is empty");
    check_what_stands_there(folder_, file_names);
    const auto lock = lock_within_seconds(partial_);
    if (!lock) throw InputError("another run is writing to it");
    lock_ = *lock;
    if (the_platform().exists(staged_ / kReady)) put_into_place_unstopped(staged_, folder_);
    clear_all_but(partial_,
                  resume ? std::set<std::string>{"lock", "journals", kTrajectories} : std::set<std::string>{"lock"});
    for (const fs::path& inside :
         {partial_ / kTrajectories, partial_ / "journals", staged_ / kTrajectories, staged_ / "reports"})
      the_platform().make_folders(inside);
  } catch (const std::exception& error) {
    if (lock_ >= 0) the_platform().close(lock_);
    const auto* of_files = dynamic_cast<const fs::filesystem_error*>(&error);
    throw InputError(fmt::format("--out {}: cannot be written: {}; give a folder that can be made or written", path,
                                 of_files ? of_files->code().message() : error.what()));
  }
}

OutputFolder::OutputFolder(const std::string& path)
    : folder_(path), partial_(folder_ / kPartial), staged_(partial_ / "staged"), is_helper_(true) {}

OutputFolder::~OutputFolder() {
  if (is_helper_) return;
  Platform& platform = the_platform();
  if (is_kept_) {
    if (!platform.exists(staged_ / kReady)) platform.try_to_remove_all(staged_);
  } else {
    // Writes first what marks the trajectories as complete, and last what keeps others out.
    for (const char* name : {"journals", "staged", kTrajectories, kReady}) platform.try_to_remove_all(partial_ / name);
    platform.try_to_remove(partial_ / "lock"), platform.try_to_remove(partial_);
  }
  platform.close(lock_);
}

void OutputFolder::write(const std::string& file_name, const std::string& text) {
  const fs::path file = staged_ / "reports" / file_name;
  try {
    write_file(file, text);
  } catch (const std::exception&) {
    the_platform().try_to_remove(file);
    throw;
  }
}

void OutputFolder::stage_trajectories(const std::vector<std::string>& trajectories) const {
  Platform& platform = the_platform();
  for (const std::string& name : trajectories) {
    const fs::path grown = partial_ / kTrajectories / name, staged = staged_ / kTrajectories / name;
    if (!platform.link(grown, staged)) platform.copy(grown, staged);
  }
  if (!platform.exists(folder_ / kTrajectories)) return;
  for (const fs::path& old : platform.entries(folder_ / kTrajectories)) {
    const fs::path there = staged_ / kTrajectories / old.filename();
    if (!is_trajectory(old) && !platform.exists(there)) platform.copy(old, there);
  }
}

void OutputFolder::publish(const std::vector<std::string>& trajectories) {
  stage_trajectories(trajectories);
  put_in_place(the_platform().inode(staged_ / kTrajectories));
}

void OutputFolder::publish_files() {
  the_platform().remove_all(staged_ / kTrajectories);
  put_in_place(kNoInode);
}

void OutputFolder::put_in_place(ino_t of_trajectories) {
  assert(!is_helper_);
  std::string ready = fmt::format("{}\n", of_trajectories);
  for (const std::string& name : file_names_) {
    if (!the_platform().exists(staged_ / "reports" / name)) ready += name + "\n";
  }
  write_file(partial_ / kReady, ready);
  the_platform().rename(partial_ / kReady, staged_ / kReady);  // there as a whole, or not at all
  put_into_place_unstopped(staged_, folder_);
}

std::vector<std::string> faults_of_writing(OutputFolder& folder, const std::vector<OutputFile>& files,
                                           const std::vector<std::string>& trajectories, bool can_resume) {
  std::vector<std::string> faults;
  std::size_t written = 0;
  for (const OutputFile& file : files) {
    try {
      folder.write(file.name, file.text());
      ++written;
    } catch (const std::exception& error) {
      faults.push_back(fmt::format("{} was not written: {}", file.name, error.what()));
    }
  }
  if (!faults.empty() && can_resume) folder.keep();
  if (written == 0) {
    faults.push_back(can_resume ? "no report was written, so no output was changed; --resume continues the run"
                                : "no report was written, so no output was changed");
    return faults;
  }
  folder.publish(trajectories);
  if (!faults.empty())
    faults.push_back(can_resume ? "the other outputs are in place; --resume writes all of them again"
                                : "the other outputs are in place");
  return faults;
}

}  // namespace rigor::inline runner
