// Inside the hidden folder:
//   lock           held by flock while a process of the run lives, in any container
//   journals/ trajectories/   of this run only; published files are links to them
//   staged/        the files to move into place, and `ready` once they are complete
#include "cases/runner/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <optional>
#include <set>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "core/base/error.h"

namespace rigor {
namespace {

namespace fs = std::filesystem;
constexpr const char *kPartial = ".rigor-partial", *kTrajectories = "trajectories", *kReady = "ready";

[[noreturn]] void fail(int number, const fs::path& path) {
  throw fs::filesystem_error("", path, std::error_code(number, std::generic_category()));
}

constexpr ino_t kNoInode = static_cast<ino_t>(-1);  // for an empty path, and for one that does not exist

ino_t inode_of(const fs::path& path) {
  struct stat about {};
  return stat(path.c_str(), &about) == 0 ? about.st_ino : 0;
}

// The lock's descriptor; none if another run holds it. A lock file that its holder has removed meanwhile locks nothing.
std::optional<int> try_to_lock(const fs::path& partial) {
  const fs::path file = partial / "lock";
  for (;;) {
    fs::create_directories(partial);
    const int lock = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (lock < 0 && errno == ENOENT) continue;
    if (lock < 0) fail(errno, file);
    const int failure = flock(lock, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
    struct stat about {};
    if (failure == 0 && fstat(lock, &about) == 0 && about.st_ino == inode_of(file)) return lock;
    close(lock);
    if (failure == EWOULDBLOCK) return {};
    if (failure != 0) fail(failure, file);
  }
}

// A run that was killed an instant ago may still have children, or be putting its outputs into place.
std::optional<int> lock_within_seconds(const fs::path& partial) {
  constexpr int kTries = 100;
  for (int i = 0; i < kTries; ++i) {
    if (const auto lock = try_to_lock(partial)) return lock;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return {};
}

// case--engine--dt.csv, as the grid names them.
bool is_trajectory(const fs::path& path) {
  const std::string name = path.filename().string();
  const std::size_t first = name.find("--");
  return path.extension() == ".csv" && first != std::string::npos && name.find("--", first + 2) != std::string::npos;
}

void write_file(const fs::path& path, const std::string& text) {
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(errno == 0 ? "it could not be written" : std::strerror(errno));
}

// At no time is there no folder of trajectories; where the file system cannot exchange two, one goes before the other
// comes.
void exchange(const fs::path& fresh, const fs::path& old) {
  if (renameat2(AT_FDCWD, fresh.c_str(), AT_FDCWD, old.c_str(), RENAME_EXCHANGE) == 0) return;
  if (fs::exists(old)) fs::rename(old, fresh.string() + ".old");
  fs::rename(fresh, old);
}

// Every step here may be interrupted and repeated by another process. A file in place is no longer staged. The inode in
// `ready` distinguishes the staged folder of trajectories from the one that it replaced.
void put_into_place(const fs::path& staged, const fs::path& folder) {
  std::ifstream ready(staged / kReady);
  ino_t fresh = 0;
  std::vector<std::string> not_written;
  ready >> fresh;
  for (std::string name; ready >> name;) not_written.push_back(name);
  if (!ready.eof()) throw std::runtime_error("what is ready could not be read");
  if (inode_of(staged / kTrajectories) == fresh) exchange(staged / kTrajectories, folder / kTrajectories);
  for (const fs::directory_entry& entry : fs::directory_iterator(staged / "reports"))
    fs::rename(entry.path(), folder / entry.path().filename());
  for (const std::string& name : not_written) fs::remove(folder / name);
  fs::remove(staged / kReady);
}

// Publishes in a separate process and session, so that killing this process does not interrupt it. If that process
// fails or is killed, this one continues from there.
void put_into_place_unstopped(const fs::path& staged, const fs::path& folder) {
  const pid_t child = fork();
  if (child < 0) return put_into_place(staged, folder);
  if (child == 0) {
    setsid();
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
    try {
      put_into_place(staged, folder);
      _exit(0);
    } catch (const std::exception&) {
      _exit(1);
    }
  }
  int status = 1;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (status == 0 || !fs::exists(staged / kReady)) return;
  try {
    put_into_place(staged, folder);
  } catch (const std::exception& error) {
    throw std::runtime_error(
        fmt::format("the outputs could not be put into '{}' as a whole: {}; the next run there begins by that",
                    folder.string(), error.what()));
  }
}

void check_what_stands_there(const fs::path& folder, const std::vector<std::string>& file_names) {
  std::error_code no_matter;
  for (const std::string& name : file_names) {
    if (fs::exists(folder / name, no_matter) && !fs::is_regular_file(folder / name))
      throw InputError(fmt::format("'{}' in it is no file", name));
  }
  for (const char* name : {kTrajectories, kPartial}) {
    if (fs::exists(folder / name, no_matter) && !fs::is_directory(folder / name))
      throw InputError(fmt::format("'{}' in it is no folder", name));
  }
}

void clear_all_but(const fs::path& folder, const std::set<std::string>& names) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (!names.contains(entry.path().filename().string())) fs::remove_all(entry.path());
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
    if (fs::exists(staged_ / kReady)) put_into_place_unstopped(staged_, folder_);
    clear_all_but(partial_,
                  resume ? std::set<std::string>{"lock", "journals", kTrajectories} : std::set<std::string>{"lock"});
    for (const fs::path& inside :
         {partial_ / kTrajectories, partial_ / "journals", staged_ / kTrajectories, staged_ / "reports"})
      fs::create_directories(inside);
  } catch (const std::exception& error) {
    if (lock_ >= 0) close(lock_);
    const auto* of_files = dynamic_cast<const fs::filesystem_error*>(&error);
    throw InputError(fmt::format("--out {}: cannot be written: {}; give a folder that can be made or written", path,
                                 of_files ? of_files->code().message() : error.what()));
  }
}

OutputFolder::OutputFolder(const std::string& path)
    : folder_(path), partial_(folder_ / kPartial), staged_(partial_ / "staged"), is_helper_(true) {}

OutputFolder::~OutputFolder() {
  if (is_helper_) return;
  std::error_code no_matter;
  if (is_kept_) {
    if (!fs::exists(staged_ / kReady, no_matter)) fs::remove_all(staged_, no_matter);
  } else {
    // Writes first what marks the trajectories as complete, and last what keeps others out.
    for (const char* name : {"journals", "staged", kTrajectories, kReady}) fs::remove_all(partial_ / name, no_matter);
    fs::remove(partial_ / "lock", no_matter), fs::remove(partial_, no_matter);
  }
  close(lock_);
}

void OutputFolder::write(const std::string& file_name, const std::string& text) {
  const fs::path file = staged_ / "reports" / file_name;
  try {
    write_file(file, text);
  } catch (const std::exception&) {
    std::error_code no_matter;
    fs::remove(file, no_matter);
    throw;
  }
}

void OutputFolder::stage_trajectories(const std::vector<std::string>& trajectories) const {
  for (const std::string& name : trajectories) {
    std::error_code not_linked;
    fs::create_hard_link(partial_ / kTrajectories / name, staged_ / kTrajectories / name, not_linked);
    if (not_linked) fs::copy_file(partial_ / kTrajectories / name, staged_ / kTrajectories / name);
  }
  if (!fs::exists(folder_ / kTrajectories)) return;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / kTrajectories)) {
    const fs::path there = staged_ / kTrajectories / entry.path().filename();
    if (!is_trajectory(entry.path()) && !fs::exists(there))
      fs::copy(entry.path(), there, fs::copy_options::recursive | fs::copy_options::copy_symlinks);
  }
}

void OutputFolder::publish(const std::vector<std::string>& trajectories) {
  stage_trajectories(trajectories);
  put_in_place(inode_of(staged_ / kTrajectories));
}

void OutputFolder::publish_files() {
  fs::remove_all(staged_ / kTrajectories);
  put_in_place(kNoInode);
}

void OutputFolder::put_in_place(ino_t of_trajectories) {
  assert(!is_helper_);
  std::string ready = fmt::format("{}\n", of_trajectories);
  for (const std::string& name : file_names_) {
    if (!fs::exists(staged_ / "reports" / name)) ready += name + "\n";
  }
  write_file(partial_ / kReady, ready);
  fs::rename(partial_ / kReady, staged_ / kReady);  // there as a whole, or not at all
  put_into_place_unstopped(staged_, folder_);
}

}  // namespace rigor
