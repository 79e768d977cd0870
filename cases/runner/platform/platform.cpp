// The machine itself.
#include "cases/runner/platform/platform.h"

#include <fcntl.h>
#include <malloc.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <limits>
#include <system_error>
#include <thread>
#include <utility>

#include "cases/runner/process_pool.h"

extern "C" void __gcov_dump() __attribute__((weak));  // of GCC; null unless the build counts

namespace rigor::inline runner {
namespace {

namespace fs = std::filesystem;

constexpr int kWatched[] = {SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t caught_signal = 0;

class RealSignalWatch : public SignalWatch {
 public:
  RealSignalWatch() {
    caught_signal = 0;
    for (std::size_t i = 0; i < std::size(kWatched); ++i) {
      struct sigaction note {};
      note.sa_handler = [](int signal) { caught_signal = signal; };
      note.sa_flags = SA_RESETHAND;
      sigaction(kWatched[i], nullptr, &before_[i]);
      if (before_[i].sa_handler != SIG_IGN) sigaction(kWatched[i], &note, nullptr);
    }
  }
  ~RealSignalWatch() override {
    for (std::size_t i = 0; i < std::size(kWatched); ++i) sigaction(kWatched[i], &before_[i], nullptr);
  }
  RealSignalWatch(const RealSignalWatch&) = delete;
  RealSignalWatch& operator=(const RealSignalWatch&) = delete;
  int caught() const override { return caught_signal; }

 private:
  struct sigaction before_[std::size(kWatched)]{};
};

// A child must not run what the parent has registered for its own exit. tests/coverage alone has counters to keep.
[[noreturn]] void leave(int code) {
  if (__gcov_dump) __gcov_dump();
  _exit(code);
}

[[noreturn]] void fail_to(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

struct Pipe {
  int read = -1, write = -1;
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) fail_to("a pipe to a child process");
    read = ends[0], write = ends[1];
    fcntl(read, F_SETFL, O_NONBLOCK);
  }
  ~Pipe() {
    if (read >= 0) ::close(read);
    if (write >= 0) ::close(write);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  int take_read() { return std::exchange(read, -1); }
};

// The parent's handlers are not for the child. Signals that the parent ignores are ignored in the child, too.
void drop_handlers() {
  for (int signal = 1; signal < NSIG; ++signal) {
    const bool stops = signal == SIGINT || signal == SIGTERM || signal == SIGHUP || signal == SIGQUIT;
    struct sigaction now {};
    if (stops && sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN) continue;
    std::signal(signal, SIG_DFL);
  }
}

[[noreturn]] void be_the_child(const std::function<void(const Channel&)>& work, const Pipe& messages, const Pipe& words,
                               pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // it died before the line above
  drop_handlers();
  std::signal(SIGXFSZ, SIG_IGN);  // but a file that grows too large is a write that fails
  // What a run frees it takes again: given back to the kernel between, a tenth of a cell's time is page faults.
  constexpr int kLargestKept = 32 << 20;  // bytes; the most that glibc allows
  mallopt(M_MMAP_THRESHOLD, kLargestKept), mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  const rlimit no_core_file{0, 0};
  setrlimit(RLIMIT_CORE, &no_core_file);
  dup2(words.write, STDOUT_FILENO);
  dup2(words.write, STDERR_FILENO);
  // An exception that left this function would continue the parent's work in the child, and remove the parent's files.
  try {
    work(Channel(messages.write));
    leave(0);
  } catch (const std::exception& error) {  // an engine may close the channel
    std::fprintf(stderr, "%s\n", error.what());
    std::fflush(stderr);
  } catch (...) {
  }
  leave(1);
}

int wait_for(pid_t child) noexcept {
  int status = 1;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

class RealPlatform : public Platform {
 public:
  int open(const Path& file, int flags) override { return ::open(file.c_str(), flags | O_CLOEXEC, 0666); }
  ssize_t read(int descriptor, char* bytes, std::size_t count) override { return ::read(descriptor, bytes, count); }
  ssize_t write(int descriptor, const char* bytes, std::size_t count) override {
    return ::write(descriptor, bytes, count);
  }
  int truncate(int descriptor, std::size_t size) override {
    if (ftruncate(descriptor, static_cast<off_t>(size)) != 0) return -1;
    return lseek(descriptor, 0, SEEK_END) < 0 ? -1 : 0;
  }
  void close(int descriptor) noexcept override { ::close(descriptor); }
  int lock(int descriptor) override { return flock(descriptor, LOCK_EX | LOCK_NB); }
  ino_t inode(int descriptor) override {
    struct stat about {};
    return fstat(descriptor, &about) == 0 ? about.st_ino : 0;
  }
  ino_t inode(const Path& path) override {
    struct stat about {};
    return stat(path.c_str(), &about) == 0 ? about.st_ino : 0;
  }
  bool exchange(const Path& a, const Path& b) override {
    return renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
  }
  bool link(const Path& file, const Path& name) override {
    std::error_code not_linked;
    fs::create_hard_link(file, name, not_linked);
    return !not_linked;
  }

  bool exists(const Path& path) noexcept override {
    std::error_code no_matter;
    return fs::exists(path, no_matter);
  }
  bool is_file(const Path& path) override { return fs::is_regular_file(path); }
  bool is_folder(const Path& path) override { return fs::is_directory(path); }
  void make_folders(const Path& path) override { fs::create_directories(path); }
  std::vector<Path> entries(const Path& folder) override {
    std::vector<Path> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) found.push_back(entry.path());
    return found;
  }
  void rename(const Path& from, const Path& to) override { fs::rename(from, to); }
  void copy(const Path& from, const Path& to) override {
    fs::copy(from, to, fs::copy_options::recursive | fs::copy_options::copy_symlinks);
  }
  void remove(const Path& path) override { fs::remove(path); }
  void remove_all(const Path& path) override { fs::remove_all(path); }
  void try_to_remove(const Path& path) noexcept override {
    std::error_code no_matter;
    fs::remove(path, no_matter);
  }
  void try_to_remove_all(const Path& path) noexcept override {
    std::error_code no_matter;
    fs::remove_all(path, no_matter);
  }

  Child start(const std::function<void(const Channel&)>& work) override {
    Pipe messages, words;
    std::fflush(nullptr);  // or a child that calls exit() would print our buffers again
    const pid_t parent = getpid();
    const pid_t child = fork();
    if (child < 0) fail_to("starting a child process");
    if (child == 0) be_the_child(work, messages, words, parent);
    return {child, messages.take_read(), words.take_read()};
  }
  bool do_unstopped(const std::function<void()>& work) override {
    const pid_t child = fork();
    if (child < 0) return false;
    if (child == 0) {
      setsid();
      for (const int signal : kWatched) std::signal(signal, SIG_IGN);
      try {
        work();
        leave(0);
      } catch (const std::exception&) {
        leave(1);
      }
    }
    return wait_for(child) == 0;
  }
  std::optional<int> status_of_ended(pid_t child) noexcept override {
    int status = 0;
    if (waitpid(child, &status, WNOHANG) != child) return {};
    return status;
  }
  int kill_and_wait(pid_t child) noexcept override {
    kill(child, SIGKILL);
    return wait_for(child);
  }
  double cpu_seconds(pid_t child) override {
    clockid_t clock{};
    timespec used{};
    if (clock_getcpuclockid(child, &clock) != 0 || clock_gettime(clock, &used) != 0) return 0;  // it has just ended
    return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
  }
  void die_of(int signal) override {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }

  Time::time_point now() noexcept override { return Time::now(); }
  void sleep(std::chrono::milliseconds time) override { std::this_thread::sleep_for(time); }
  void wait_for_input(std::vector<pollfd>& watched, int ms) override { poll(watched.data(), watched.size(), ms); }
  std::unique_ptr<SignalWatch> watch_signals() override { return std::make_unique<RealSignalWatch>(); }
};

RealPlatform machine;
Platform* in_place = &machine;

}  // namespace

Platform& the_platform() { return *in_place; }

PlatformInPlace::PlatformInPlace(Platform& platform) : before_(std::exchange(in_place, &platform)) {}
PlatformInPlace::~PlatformInPlace() { in_place = before_; }

ReadFile read_file(const Platform::Path& file) {
  Platform& platform = the_platform();
  const int descriptor = platform.open(file, O_RDONLY);
  if (descriptor < 0) return {};
  ReadFile read;
  constexpr std::size_t kAtOnce = 1 << 16;
  for (;;) {
    const std::size_t before = read.bytes.size();
    read.bytes.resize(before + kAtOnce);
    const ssize_t count = platform.read(descriptor, read.bytes.data() + before, kAtOnce);
    read.bytes.resize(before + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    if (count < 0 && errno == EINTR) continue;
    read.is_whole = count == 0;
    if (count <= 0) break;
  }
  platform.close(descriptor);
  return read;
}

void write_file(const Platform::Path& file, const std::string& text) {
  Platform& platform = the_platform();
  const int descriptor = platform.open(file, O_WRONLY | O_CREAT | O_TRUNC);
  int failure = descriptor < 0 ? errno : 0;
  for (std::size_t at = 0; failure == 0 && at < text.size();) {
    const ssize_t count = platform.write(descriptor, text.data() + at, text.size() - at);
    if (count > 0) at += static_cast<std::size_t>(count);
    if (count < 0 && errno != EINTR) failure = errno;
  }
  if (descriptor >= 0) platform.close(descriptor);
  if (failure != 0) throw std::runtime_error(std::strerror(failure));
}

}  // namespace rigor::inline runner
