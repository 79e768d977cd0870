#include "adapters/plugin/shared_library.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <vector>

#include "adapters/plugin/in_quotes.h"
#include "adapters/plugin/memory_limit.h"
#include "core/base/error.h"
#include "core/base/sanitizers.h"

namespace rigor::inline adapters {
namespace {

using Stopwatch = std::chrono::steady_clock;
using Entry = const rigor_engine_v1* (*)(std::uint32_t);

std::string called(const std::string& path) { return fmt::format("plug-in '{}'", path); }

// An engine's own copy of a library that Rigor links, Bullet in single precision say, must find its own symbols first.
// The address sanitizer cannot be bypassed like that.
constexpr int kHow = RTLD_NOW | RTLD_LOCAL | (kHasAddressSanitizer ? 0 : RTLD_DEEPBIND);

std::string asked_info(const rigor_engine_v1& engine, const std::string& path) {
  std::vector<char> room(kRoomForText, '\0');
  const rigor_status status = engine.info({room.data(), room.size() - 1});
  const std::string text = room.data();
  if (status != RIGOR_OK)
    throw InputError(fmt::format("{} does not say what it is: {}", called(path), in_quotes(text)));
  return text;
}

// Sends 'i' and the description, or 'e' and an error sentence.
[[noreturn]] void probe(const std::string& path, int to, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  for (int signal = 1; signal < NSIG; ++signal) std::signal(signal, SIG_DFL);
  const rlimit no_core_file{0, 0};
  setrlimit(RLIMIT_CORE, &no_core_file);
  limit_memory();
  dup2(STDERR_FILENO, STDOUT_FILENO);  // its printed output is not part of our data
  std::string answer;
  try {
    answer = "i" + asked_info(load_library(path), path);
  } catch (const InputError& error) {
    answer = std::string("e") + error.what();
  } catch (...) {
    answer = "e" + called(path) + " threw an exception when it was asked what it is";
  }
  for (std::size_t at = 0; at < answer.size();) {
    const ssize_t count = write(to, answer.data() + at, answer.size() - at);
    if (count <= 0 && errno != EINTR) break;
    if (count > 0) at += static_cast<std::size_t>(count);
  }
  _exit(0);
}

// All that comes until the end; false if that does not come in time.
bool read_all(int from, double limit, std::string& text) {
  const auto begin = Stopwatch::now();
  char buffer[1 << 12];
  while (std::chrono::duration<double>(Stopwatch::now() - begin).count() < limit) {
    pollfd watched{from, POLLIN, 0};
    if (poll(&watched, 1, 50) <= 0) continue;
    const ssize_t count = read(from, buffer, sizeof buffer);
    if (count == 0) return true;
    if (count > 0) text.append(buffer, static_cast<std::size_t>(count));
  }
  return false;
}

std::string end_in_words(int status) {
  if (WIFEXITED(status)) return fmt::format("called exit({})", WEXITSTATUS(status));
  const char* signal = sigabbrev_np(WTERMSIG(status));
  return fmt::format("was killed by SIG{}", signal ? signal : "?");
}

}  // namespace

const rigor_engine_v1& load_library(const std::string& path) {
  const std::string file = std::filesystem::absolute(path).string();  // a bare name would be looked for elsewhere
  void* library = dlopen(file.c_str(), kHow);
  if (!library) throw InputError(fmt::format("{} cannot be loaded: {}", called(path), dlerror()));
  void* symbol = dlsym(library, "rigor_engine_entry");
  if (!symbol) throw InputError(fmt::format("{} has no function rigor_engine_entry; see rigor_engine.h", called(path)));
  const rigor_engine_v1* engine = reinterpret_cast<Entry>(symbol)(RIGOR_ENGINE_ABI_MAJOR);
  if (!engine)
    throw InputError(
        fmt::format("{} does not speak version {} of rigor_engine.h", called(path), RIGOR_ENGINE_ABI_MAJOR));
  constexpr std::size_t kLeast = offsetof(rigor_engine_v1, contacts);  // what follows is optional
  if (engine->struct_size < kLeast)
    throw InputError(fmt::format("{} has a struct of {} bytes; version {} of rigor_engine.h has {}", called(path),
                                 engine->struct_size, RIGOR_ENGINE_ABI_MAJOR, kLeast));
  if (!engine->info || !engine->load || !engine->step || !engine->read || !engine->unload)
    throw InputError(fmt::format("{} leaves out one of info, load, step, read and unload", called(path)));
  return *engine;
}

std::string info_of_library(const std::string& path, double limit) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "a pipe to a plug-in");
  std::fflush(nullptr);  // or a library that calls exit() would print our buffers again
  const pid_t parent = getpid(), pid = fork();
  if (pid < 0) throw std::system_error(errno, std::generic_category(), "starting a plug-in");
  if (pid == 0) probe(path, ends[1], parent);
  close(ends[1]);
  std::string answer;
  const bool is_in_time = read_all(ends[0], limit, answer);
  close(ends[0]);
  if (!is_in_time) kill(pid, SIGKILL);
  int status = 0;
  waitpid(pid, &status, 0);
  if (!is_in_time)
    throw InputError(fmt::format("{} did not say what it is within the limit of {:g} s", called(path), limit));
  if (answer.empty())
    throw InputError(fmt::format("{} {} when it was loaded and asked what it is", called(path), end_in_words(status)));
  if (answer.front() != 'i') throw InputError(answer.substr(1));
  return answer.substr(1);
}

}  // namespace rigor::inline adapters
