#include "adapters/plugin/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <fstream>
#include <system_error>
#include <utility>

#include "adapters/plugin/in_quotes.h"
#include "adapters/plugin/memory_limit.h"
#include "core/base/error.h"
#include "core/engine/engine_failure.h"

namespace rigor::inline adapters {
namespace {

using Stopwatch = std::chrono::steady_clock;

constexpr double kWaits = 10;                    // times the limit, by the clock: the most for an answer
constexpr double kBrief = 60e-6;                 // s
constexpr int kTick = 50;                        // ms between two looks at the time
constexpr std::size_t kMostPassedOn = 16 << 10;  // bytes of one child's stderr
constexpr std::size_t kWordsKept = 4 << 10;      // bytes, for its last words
constexpr int kRoomInPipe = 1 << 20;             // bytes: a large answer in one go
constexpr int kGraceful = 500;                   // ms from the closing of its stdin to its killing

void make_pipe(int ends[2]) {
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "a pipe to a plug-in");
}

void close_one(int& descriptor) {
  if (descriptor >= 0) close(std::exchange(descriptor, -1));
}

double seconds_since(Stopwatch::time_point begin) {
  return std::chrono::duration<double>(Stopwatch::now() - begin).count();
}

double seconds_of(clockid_t clock) {
  timespec used{};
  if (clock_gettime(clock, &used) != 0) return 0;
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

void sleep_briefly() {
  const timespec millisecond{0, 1000000};
  nanosleep(&millisecond, nullptr);
}

// Whether it waits for something, and not for its turn on a busy machine: then it may take no longer than its limit.
bool is_asleep(pid_t pid) {
  std::ifstream file(fmt::format("/proc/{}/stat", pid));
  std::string text;
  std::getline(file, text);
  const std::size_t state = text.rfind(") ");  // behind the name, which may hold anything
  return state != std::string::npos && text.size() > state + 2 && text[state + 2] != 'R' && text[state + 2] != 'D';
}

// Whether the child has ended, without taking its process number from the group that it leads.
bool has_ended(pid_t pid, siginfo_t& how) {
  how.si_pid = 0;
  return waitid(P_PID, static_cast<id_t>(pid), &how, WEXITED | WNOHANG | WNOWAIT) == 0 && how.si_pid == pid;
}

bool ends_within(pid_t pid, int milliseconds, siginfo_t& how) {
  for (int n = 0; n < milliseconds; ++n) {
    if (has_ended(pid, how)) return true;
    sleep_briefly();
  }
  return has_ended(pid, how);
}

}  // namespace

ChildProcess::ChildProcess(std::string command, double limit, int log, std::string name)
    : command_(std::move(command)), name_(std::move(name)), limit_(limit), log_(log), owner_(getpid()) {
  std::signal(SIGPIPE, SIG_IGN);  // a child that is gone is a failed write
  int in[2], out[2], err[2];
  make_pipe(in), make_pipe(out), make_pipe(err);
  begin_ = asked_ = Stopwatch::now();
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ < 0) throw std::system_error(errno, std::generic_category(), "starting a plug-in");
  if (pid_ == 0) become_the_child(in[0], out[1], err[1], parent);
  setpgid(pid_, pid_);  // here as well as there, whichever runs first
  close(in[0]), close(out[1]), close(err[1]);
  to_ = in[1], from_ = out[0], words_from_ = err[0];
  for (const int descriptor : {to_, from_, words_from_}) fcntl(descriptor, F_SETFL, O_NONBLOCK);
  fcntl(from_, F_SETPIPE_SZ, kRoomInPipe);  // of no harm where it is refused
}

// Between fork and exec: system calls alone.
void ChildProcess::become_the_child(int in, int out, int err, pid_t parent) const {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  dup2(in, STDIN_FILENO), dup2(out, STDOUT_FILENO), dup2(err, STDERR_FILENO);
  close_range(3, ~0u, 0);
  for (int signal = 1; signal < NSIG; ++signal) std::signal(signal, SIG_DFL);
  const rlimit no_core_file{0, 0};
  setrlimit(RLIMIT_CORE, &no_core_file);
  limit_memory();
  const std::string line = "exec " + command_;
  execl("/bin/sh", "sh", "-c", line.c_str(), static_cast<char*>(nullptr));
  _exit(127);
}

bool ChildProcess::is_ours() const { return owner_ == getpid(); }

void ChildProcess::close_pipes() { close_one(to_), close_one(from_), close_one(words_from_); }

ChildProcess::~ChildProcess() {
  close_one(to_);
  if (is_ours()) {
    siginfo_t how{};
    close_one(from_);  // stops one that writes forever
    ends_within(pid_, kGraceful, how);
    kill(-pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    read_words();
  }
  close_pipes();
}

std::string ChildProcess::ask(const std::string& line, const std::string& request, std::size_t longest_answer) {
  refuse_unasked(request);
  asked_ = Stopwatch::now(), asleep_ = 0;
  out_ = line + "\n";
  send();  // most requests go at once
  look_briefly();
  std::size_t looked_at = 0, end = std::string::npos;
  exchange(request, [&] {
    end = in_.find('\n', looked_at);
    looked_at = in_.size();
    if (std::min(end, in_.size()) > longest_answer)
      throw EngineFailure(FailureKind::invalid,
                          fmt::format("{} answered '{}' with a line of more than {} bytes, which begins {}", name_,
                                      request, longest_answer, in_quotes(in_)));
    return end != std::string::npos;
  });
  std::string answer = in_.substr(0, end);
  in_.erase(0, end + 1);
  if (!answer.empty() && answer.back() == '\r') answer.pop_back();
  return answer;
}

void ChildProcess::receive(char* into, std::size_t bytes, const std::string& request) {
  exchange(request, [&] { return in_.size() >= bytes; });
  std::memcpy(into, in_.data(), bytes);
  in_.erase(0, bytes);
}

void ChildProcess::refuse_unasked(const std::string& request) {
  if (in_.empty()) read_answer();
  if (in_.empty()) return;
  throw EngineFailure(FailureKind::invalid, fmt::format("{} said something before it was asked for '{}': {}", name_,
                                                        request, in_quotes(in_.substr(0, in_.find('\n')))));
}

template <typename Done>
void ChildProcess::exchange(const std::string& request, const Done& done) {
  while (!done()) {
    check_time(request);
    pollfd watched[] = {{from_, POLLIN, 0}, {words_from_, POLLIN, 0}, {out_.empty() ? -1 : to_, POLLOUT, 0}};
    const auto begin = Stopwatch::now();
    if (poll(watched, 3, kTick) == 0 && is_asleep(pid_)) asleep_ += seconds_since(begin);
    if (watched[1].revents) read_words();
    if (watched[2].revents) send();
    if (watched[0].revents && !read_answer() && !done()) report_end(request);
  }
}

void ChildProcess::send() {
  const ssize_t count = write(to_, out_.data(), out_.size());
  if (count > 0) out_.erase(0, static_cast<std::size_t>(count));
  if (count < 0 && errno != EAGAIN && errno != EINTR) out_.clear();  // it no longer listens, but may have answered
}

// Polls first, because waking up takes longer than most steps. Yields to others that wait for this core.
void ChildProcess::look_briefly() {
  const double begin = seconds_of(CLOCK_THREAD_CPUTIME_ID);
  while (in_.empty() && seconds_since(asked_) < kBrief && read_answer()) sched_yield();
  looked_for_ += seconds_of(CLOCK_THREAD_CPUTIME_ID) - begin;
}

bool ChildProcess::read_answer() {
  char buffer[1 << 16];
  const ssize_t count = from_ < 0 ? 0 : read(from_, buffer, sizeof buffer);
  if (count > 0) in_.append(buffer, static_cast<std::size_t>(count));
  return count > 0 || (count < 0 && (errno == EAGAIN || errno == EINTR));
}

void ChildProcess::read_words() {
  char buffer[1 << 12];
  const ssize_t count = words_from_ < 0 ? 0 : read(words_from_, buffer, sizeof buffer);
  if (count == 0) close_one(words_from_);
  if (count <= 0) return;
  const std::string words(buffer, static_cast<std::size_t>(count));
  words_ += words;
  if (words_.size() > kWordsKept) words_.erase(0, words_.size() - kWordsKept);
  pass_on(words);
}

void ChildProcess::pass_on(const std::string& words) {
  if (log_ < 0 || passed_on_ >= kMostPassedOn) return;
  std::string shown;
  std::size_t at = 0;
  while (at < words.size()) {
    const std::size_t end = std::min(words.find('\n', at), words.size());
    shown += fmt::format("{}: {}\n", name_, words.substr(at, end - at));
    at = end + 1;
  }
  passed_on_ += words.size();
  if (passed_on_ >= kMostPassedOn) shown += fmt::format("{}: (what else it says is not shown)\n", name_);
  // Nobody may be reading; that is no fault of the engine's.
  [[maybe_unused]] const ssize_t written = write(log_, shown.data(), shown.size());
}

double ChildProcess::cpu_seconds() const {
  clockid_t clock{};
  return clock_getcpuclockid(pid_, &clock) == 0 ? seconds_of(clock) : 0;  // it may just have ended
}

void ChildProcess::check_time(const std::string& request) const {
  if (asleep_ > limit_ || seconds_since(asked_) > kWaits * limit_)
    throw EngineFailure(FailureKind::timed_out, fmt::format("{} did not answer '{}' within the limit of {:g} s{}",
                                                            name_, request, limit_, last_words()));
  // Looked at only once there can be so much of it.
  if (seconds_since(begin_) > limit_ && cpu_seconds() > limit_)
    throw EngineFailure(FailureKind::timed_out, fmt::format("{} has used up the limit of {:g} s of CPU time, at '{}'{}",
                                                            name_, limit_, request, last_words()));
}

void ChildProcess::report_end(const std::string& request) {
  siginfo_t how{};
  if (!ends_within(pid_, kGraceful, how)) {
    throw EngineFailure(FailureKind::crashed, fmt::format("{} closed its stdout before it had answered '{}'{}", name_,
                                                          request, last_words()));
  }
  read_words();
  const bool is_exit = how.si_code == CLD_EXITED;
  const char* signal = is_exit ? nullptr : sigabbrev_np(how.si_status);
  const std::string end = is_exit ? fmt::format("ended with exit code {}", how.si_status)
                                  : fmt::format("was killed by SIG{}", signal ? signal : "?");
  const std::string half = in_.empty() ? "" : fmt::format("; it had said {}", in_quotes(in_));
  throw EngineFailure(FailureKind::crashed,
                      fmt::format("{} {} before it had answered '{}'{}{}", name_, end, request, half, last_words()));
}

std::string ChildProcess::last_words() const {
  std::string words = words_;
  while (!words.empty() && static_cast<unsigned char>(words.back()) <= ' ') words.pop_back();
  words.erase(0, words.find_last_of('\n') + 1);
  return words.empty() ? "" : fmt::format("; its last words: {}", in_quotes(words));
}

}  // namespace rigor::inline adapters
