#include "cases/runner/forked_child.h"

#include <fcntl.h>
#include <malloc.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <limits>
#include <system_error>

#include "core/base/error.h"

namespace rigor {
namespace {

// A limit is one of CPU time, so that no verdict depends on what else the machine does; a job that sleeps ends too,
// after so many times its limit by the clock.
constexpr double kWaits = 10;

// A job that has sent something may continue as long as it sends something from time to time. Its limit is this many
// times its own by the clock, twice the longest time of its children. A stopped job sends nothing.
constexpr double kSilence = 2 * kWaits;

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

struct Pipe {
  Descriptor read, write;
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) fail("a pipe to a child process");
    read.reset(ends[0]), write.reset(ends[1]);
    fcntl(ends[0], F_SETFL, O_NONBLOCK);
  }
};

// Appends the available data. Closes the descriptor at its end.
void drain(Descriptor& from, std::string& into) {
  char buffer[1 << 16];
  while (from.number() >= 0) {
    const ssize_t count = read(from.number(), buffer, sizeof buffer);
    if (count > 0) into.append(buffer, count);
    if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) from.close();
    if (count < 0 && errno != EINTR) return;
  }
}

// The parent's handlers are not for the child. Signals that the parent ignores are ignored in the child, too.
void drop_handlers() {
  for (int signal = 1; signal < NSIG; ++signal) {
    const bool stops = signal == SIGINT || signal == SIGTERM || signal == SIGHUP || signal == SIGQUIT;
    struct sigaction now {};
    if (stops && sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN) continue;
    std::signal(signal, SIG_DFL);
  }
}

// Does the job and sends how it ended.
void do_and_tell(const Job& job, const Channel& channel) {
  try {
    job.work(channel);
    channel.send_frame('d', "");
  } catch (const InputError& error) {
    channel.send_frame('i', error.what());
  } catch (const std::exception& error) {
    channel.send_frame('e', error.what());
  } catch (const Interrupted& interruption) {  // a child that itself waits for children
    std::signal(interruption.signal, SIG_DFL);
    std::raise(interruption.signal);
  } catch (...) {
    channel.send_frame('e', "an exception of an unknown type");
  }
}

[[noreturn]] void be_the_child(const Job& job, const Pipe& messages, const Pipe& words, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // it died before the line above
  drop_handlers();
  std::signal(SIGXFSZ, SIG_IGN);  // but a file that grows too large is a write that fails
  // What a run frees it takes again: given back to the kernel between, a tenth of a cell's time is page faults.
  constexpr int kLargestKept = 32 << 20;  // bytes; the most that glibc allows
  mallopt(M_MMAP_THRESHOLD, kLargestKept), mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  const rlimit no_core_file{0, 0};
  setrlimit(RLIMIT_CORE, &no_core_file);
  dup2(words.write.number(), STDOUT_FILENO);
  dup2(words.write.number(), STDERR_FILENO);
  // An exception that left this function would continue the parent's work in the child, and remove the parent's files.
  try {
    do_and_tell(job, Channel(messages.write.number()));
    _exit(0);
  } catch (const std::exception& error) {  // an engine may close the channel
    std::fprintf(stderr, "%s\n", error.what());
    std::fflush(stderr);
  } catch (...) {
  }
  _exit(1);
}

// The last line with something on it, its control characters blanked.
std::string last_line(std::string text) {
  constexpr std::size_t kLongest = 300;
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  text.erase(0, text.find_last_of('\n') + 1);
  if (text.size() > kLongest) text.resize(kLongest);
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text;
}

std::chrono::steady_clock::duration seconds(double s) {
  constexpr double kForever = 1e8;  // s; more would overflow the clock
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(std::min(s, kForever)));
}

}  // namespace

void Channel::send_frame(char kind, const std::string& text) const {
  const std::uint64_t length = text.size();
  std::string frame(1 + sizeof length, kind);
  std::memcpy(frame.data() + 1, &length, sizeof length);
  frame += text;
  for (std::size_t at = 0; at < frame.size();) {
    const ssize_t count = write(descriptor_, frame.data() + at, frame.size() - at);
    if (count < 0 && errno != EINTR) fail("sending a result to the parent process");
    if (count > 0) at += count;
  }
}

void Descriptor::close() {
  if (number_ >= 0) ::close(number_);
  number_ = -1;
}

ForkedChild::ForkedChild(const Job& work, std::size_t index) : job(index), limit_(work.limit) {
  Pipe messages, words;
  std::fflush(nullptr);  // or a child that calls exit() would print our buffers again
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ < 0) fail("starting a child process");
  if (pid_ == 0) be_the_child(work, messages, words, parent);
  messages_.take(messages.read), words_.take(words.read);
}

ForkedChild::~ForkedChild() {
  if (pid_ > 0) kill(pid_, SIGKILL), waitpid(pid_, nullptr, 0);
}

void ForkedChild::listen(const std::function<void(std::size_t, const std::string&)>& on_message) {
  constexpr std::size_t kWordsKept = 1 << 16;
  drain(words_, spoken_);
  if (spoken_.size() > kWordsKept) spoken_.erase(0, spoken_.size() - kWordsKept);
  drain(messages_, received_);
  std::size_t at = 0;
  std::uint64_t length = 0;
  while (received_.size() - at >= 1 + sizeof length) {
    std::memcpy(&length, received_.data() + at + 1, sizeof length);
    if (received_.size() - at - 1 - sizeof length < length) break;
    take_frame(received_[at], received_.substr(at + 1 + sizeof length, length), on_message);
    at += 1 + sizeof length + length;
  }
  received_.erase(0, at);
}

bool ForkedChild::has_ended() {
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return false;
  pid_ = -1;
  status_ = status;
  return true;
}

bool ForkedChild::is_late() const {
  if (closing_kind_ || has_sent_) return Time::now() - last_heard_ > seconds(kSilence * limit_);
  return cpu_seconds() > limit_ || Time::now() - begin_ > seconds(kWaits * limit_);
}

void ForkedChild::stop() {
  kill(pid_, SIGKILL);
  waitpid(pid_, &status_, 0);
  pid_ = -1;
  timed_out_ = true;
}

JobEnd ForkedChild::end() const {
  JobEnd end;
  end.last_words = last_line(spoken_);
  end.text = closing_text_;
  end.seconds = std::chrono::duration<double>(Time::now() - begin_).count();
  if (closing_kind_) {
    end.how = closing_kind_ == 'd' ? Ending::finished : closing_kind_ == 'i' ? Ending::refused : Ending::threw;
  } else if (timed_out_) {
    end.how = Ending::timed_out;
  } else {
    end.how = WIFSIGNALED(status_) ? Ending::killed : Ending::exited;
    end.code = WIFSIGNALED(status_) ? WTERMSIG(status_) : WEXITSTATUS(status_);
  }
  return end;
}

// The CPU time of all its threads.
double ForkedChild::cpu_seconds() const {
  clockid_t clock{};
  timespec used{};
  if (clock_getcpuclockid(pid_, &clock) != 0 || clock_gettime(clock, &used) != 0) return 0;  // it has just ended
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

void ForkedChild::take_frame(char kind, const std::string& text,
                             const std::function<void(std::size_t, const std::string&)>& on_message) {
  last_heard_ = Time::now();
  if (kind != 'm') {
    closing_kind_ = kind, closing_text_ = text;
  } else {
    has_sent_ = true;
    on_message(job, text);
  }
}

}  // namespace rigor
