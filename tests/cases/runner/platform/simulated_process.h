// What a simulated machine keeps of pipes, open files and processes; for its own files alone.
#pragma once

#include <csetjmp>
#include <csignal>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <ucontext.h>

#include "tests/cases/runner/platform/simulated_platform.h"

namespace rigor::test {

inline constexpr double kForever = std::numeric_limits<double>::infinity();
inline constexpr int kKilled = SIGKILL;  // as a status of waitpid

constexpr int status_of_exit(int code) { return code << 8; }

template <typename Each>
void each_name(std::string_view path, const Each& each) {
  while (!path.empty()) {
    const std::size_t slash = std::min(path.find('/'), path.size());
    if (slash > 0) each(path.substr(0, slash));
    path.remove_prefix(std::min(slash + 1, path.size()));
  }
}

// The exceptions that a fiber is handling; a thread has one such record.
struct Handled {
  void* caught = nullptr;
  unsigned int uncaught = 0;
};

struct SimulatedPlatform::Pipe {
  std::string bytes;
  int readers = 1, writers = 1;
};

// An open file, or one end of a pipe.
struct SimulatedPlatform::Opened {
  NodePtr file;
  std::size_t at = 0;
  std::shared_ptr<Pipe> pipe;
  bool is_reader = false, is_locked = false;
  std::vector<int> owners;
};

struct SimulatedPlatform::Process {
  int number = 0, parent = 0, level = 0;
  bool is_detached = false;
  std::function<void(Process&)> body;
  char* stack = nullptr;
  ucontext_t first;
  std::jmp_buf at;
  Handled handled;
  bool is_started = false, is_done = false, is_dead = false, is_dying = false;
  int status = 0;
  int requests_left = -1;      // of an orphan
  double wakes_at = 0;         // s; blocked until then
  std::vector<int> inputs;     // or until one of these has something
  int awaits = 0;              // or until this process has ended
  int buries = 0;              // or until this one is no more
  const Pipe* full = nullptr;  // or until this has room
  double used = 0, spends_from = -1;
  int watches = 0, caught = 0;
};

}  // namespace rigor::test
