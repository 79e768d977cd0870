// All that the runner asks of the machine: files, processes, a clock and signals. A test puts a simulated machine in
// its place, and so runs the pool, the grid, the journal and the output folder under faults. Functions that may be
// called while a process is torn down are noexcept.
#pragma once

#include <poll.h>
#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rigor::inline runner {

class Channel;  // process_pool.h

// While it lives, the first SIGINT, SIGTERM or SIGHUP is noted. A second one acts as if Rigor had not asked.
class SignalWatch {
 public:
  virtual ~SignalWatch() = default;
  virtual int caught() const = 0;  // 0: none
};

class Platform {
 public:
  using Path = std::filesystem::path;
  using Time = std::chrono::steady_clock;

  virtual ~Platform() = default;

  // They act as the calls of these names: -1, and errno.
  virtual int open(const Path& file, int flags) = 0;
  virtual ssize_t read(int descriptor, char* bytes, std::size_t count) = 0;
  virtual ssize_t write(int descriptor, const char* bytes, std::size_t count) = 0;
  virtual int truncate(int descriptor, std::size_t size) = 0;  // and goes on at the end
  virtual void close(int descriptor) noexcept = 0;
  virtual int lock(int descriptor) = 0;  // at once or not at all; held until no process has the descriptor
  virtual ino_t inode(int descriptor) = 0;
  virtual ino_t inode(const Path& path) = 0;                  // 0: nothing is there
  virtual bool exchange(const Path& a, const Path& b) = 0;    // false: not here, or one of them does not exist
  virtual bool link(const Path& file, const Path& name) = 0;  // false: not here

  // They act as those of std::filesystem, which throw filesystem_error.
  virtual bool exists(const Path& path) noexcept = 0;
  virtual bool is_file(const Path& path) = 0;
  virtual bool is_folder(const Path& path) = 0;
  virtual void make_folders(const Path& path) = 0;
  virtual std::vector<Path> entries(const Path& folder) = 0;
  virtual void rename(const Path& from, const Path& to) = 0;
  virtual void copy(const Path& from, const Path& to) = 0;  // with all below it; links stay links
  virtual void remove(const Path& path) = 0;
  virtual void remove_all(const Path& path) = 0;
  virtual void try_to_remove(const Path& path) noexcept = 0;
  virtual void try_to_remove_all(const Path& path) noexcept = 0;

  struct Child {
    pid_t process;
    int messages, words;  // the reading ends of its pipes: what it sends, and what it prints
  };
  // Starts a process that does `work` and dies with this one. Throws std::system_error.
  virtual Child start(const std::function<void(const Channel&)>& work) = 0;
  // Does `work` in a process that goes on if this one is killed, and waits for it. False if it could not be started,
  // threw or was killed.
  virtual bool do_unstopped(const std::function<void()>& work) = 0;
  virtual std::optional<int> status_of_ended(pid_t child) noexcept = 0;  // none: it has not ended
  virtual int kill_and_wait(pid_t child) noexcept = 0;                   // the status that it ended with
  virtual double cpu_seconds(pid_t child) = 0;                           // of all its threads
  virtual void die_of(int signal) = 0;

  virtual Time::time_point now() noexcept = 0;
  virtual void sleep(std::chrono::milliseconds time) = 0;
  virtual void wait_for_input(std::vector<pollfd>& watched, int ms) = 0;
  virtual std::unique_ptr<SignalWatch> watch_signals() = 0;
};

Platform& the_platform();  // the machine, unless a test has put another in its place

// Puts a platform in the machine's place while it lives.
class PlatformInPlace {
 public:
  explicit PlatformInPlace(Platform& platform);
  ~PlatformInPlace();
  PlatformInPlace(const PlatformInPlace&) = delete;
  PlatformInPlace& operator=(const PlatformInPlace&) = delete;

 private:
  Platform* before_;
};

// As far as the file can be read.
struct ReadFile {
  std::string bytes;
  bool is_whole = false;
};
ReadFile read_file(const Platform::Path& file);

// Throws std::runtime_error with the reason.
void write_file(const Platform::Path& file, const std::string& text);

}  // namespace rigor::inline runner
