#include "cases/runner/process_pool.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <limits>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/base/error.h"

namespace rigor {
namespace {

using Time = std::chrono::steady_clock;

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t caught_signal = 0;

// A limit is one of CPU time, so that no verdict depends on what else the machine does; a job that sleeps ends too,
// after so many times its limit by the clock.
constexpr double kWaits = 10;

// A job that has sent something may go on for as long as it says something from time to time: within so many times its
// limit by the clock, twice what the longest of its own children may take. One that was stopped says nothing.
constexpr double kSilence = 2 * kWaits;

// While it lives, the first SIGINT, SIGTERM or SIGHUP is noted; a second one acts as if Rigor had not asked.
class SignalWatch {
 public:
  SignalWatch() {
    caught_signal = 0;
    for (std::size_t i = 0; i < std::size(kSignals); ++i) {
      struct sigaction note {};
      note.sa_handler = [](int signal) { caught_signal = signal; };
      note.sa_flags = SA_RESETHAND;
      sigaction(kSignals[i], nullptr, &before_[i]);
      if (before_[i].sa_handler != SIG_IGN) sigaction(kSignals[i], &note, nullptr);
    }
  }
  ~SignalWatch() {
    for (std::size_t i = 0; i < std::size(kSignals); ++i) sigaction(kSignals[i], &before_[i], nullptr);
  }
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

 private:
  struct sigaction before_[std::size(kSignals)]{};
};

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  void reset(int number) { close(), number_ = number; }
  void take(Descriptor& from) { reset(std::exchange(from.number_, -1)); }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

struct Pipe {
  Descriptor read, write;
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) fail("a pipe to a child process");
    read.reset(ends[0]), write.reset(ends[1]);
    fcntl(ends[0], F_SETFL, O_NONBLOCK);
  }
};

// Appends what is there to read. Closes the descriptor at its end.
void drain(Descriptor& from, std::string& into) {
  char buffer[1 << 16];
  while (from.number() >= 0) {
    const ssize_t count = read(from.number(), buffer, sizeof buffer);
    if (count > 0) into.append(buffer, count);
    if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) from.close();
    if (count < 0 && errno != EINTR) return;
  }
}

[[noreturn]] void be_the_child(const Job& job, const Pipe& messages, const Pipe& words, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);                                           // it died before the line above
  for (int signal = 1; signal < NSIG; ++signal) std::signal(signal, SIG_DFL);  // the parent's handlers are not for it
  std::signal(SIGXFSZ, SIG_IGN);  // but a file that grows too large is a write that fails
  // What a run frees it takes again: given back to the kernel between, a tenth of a cell's time is page faults.
  constexpr int kLargestKept = 32 << 20;  // bytes; the most that glibc allows
  mallopt(M_MMAP_THRESHOLD, kLargestKept), mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  const rlimit no_core_file{0, 0};
  setrlimit(RLIMIT_CORE, &no_core_file);
  dup2(words.write.number(), STDOUT_FILENO);
  dup2(words.write.number(), STDERR_FILENO);
  const Channel channel(messages.write.number());
  try {
    job.work(channel);
    channel.send_frame('d', "");
  } catch (const InputError& error) {
    channel.send_frame('i', error.what());
  } catch (const std::exception& error) {
    channel.send_frame('e', error.what());
  } catch (...) {
    channel.send_frame('e', "an exception that is no std::exception");
  }
  _exit(0);
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

class Child {
 public:
  Child(const Job& work, std::size_t index) : job(index), limit_(work.limit) {
    Pipe messages, words;
    std::fflush(nullptr);  // or a child that calls exit() would print our buffers again
    const pid_t parent = getpid();
    pid_ = fork();
    if (pid_ < 0) fail("starting a child process");
    if (pid_ == 0) be_the_child(work, messages, words, parent);
    messages_.take(messages.read), words_.take(words.read);
  }
  ~Child() {
    if (pid_ > 0) kill(pid_, SIGKILL), waitpid(pid_, nullptr, 0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  const std::size_t job;

  int messages_descriptor() const { return messages_.number(); }
  int words_descriptor() const { return words_.number(); }
  bool has_closed_its_pipes() const { return messages_.number() < 0 && words_.number() < 0; }

  // Reads what has come; hands over each whole message.
  template <typename OnMessage>
  void listen(const OnMessage& on_message) {
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

  bool has_ended() {
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) != pid_) return false;
    pid_ = -1;
    status_ = status;
    return true;
  }

  bool is_late() const {
    if (closing_kind_ || has_sent_) return Time::now() - last_heard_ > seconds(kSilence * limit_);
    return cpu_seconds() > limit_ || Time::now() - begin_ > seconds(kWaits * limit_);
  }
  void stop() {
    kill(pid_, SIGKILL);
    waitpid(pid_, &status_, 0);
    pid_ = -1;
    timed_out_ = true;
  }

  JobEnd end() const {
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

 private:
  // Of all its threads.
  double cpu_seconds() const {
    clockid_t clock{};
    timespec used{};
    if (clock_getcpuclockid(pid_, &clock) != 0 || clock_gettime(clock, &used) != 0) return 0;  // it has just ended
    return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
  }

  static Time::duration seconds(double s) {
    constexpr double kForever = 1e8;  // s; more would overflow the clock
    return std::chrono::duration_cast<Time::duration>(std::chrono::duration<double>(std::min(s, kForever)));
  }

  template <typename OnMessage>
  void take_frame(char kind, const std::string& text, const OnMessage& on_message) {
    last_heard_ = Time::now();
    if (kind != 'm') {
      closing_kind_ = kind, closing_text_ = text;
    } else {
      has_sent_ = true;
      on_message(job, text);
    }
  }

  Time::time_point begin_ = Time::now(), last_heard_ = begin_;
  double limit_;  // s
  pid_t pid_ = -1;
  int status_ = 0;
  Descriptor messages_, words_;
  std::string received_, spoken_, closing_text_;
  char closing_kind_ = 0;
  bool has_sent_ = false, timed_out_ = false;
};

using Children = std::vector<std::unique_ptr<Child>>;

// Until a child says something, or a tick is over. A child's end shows as the closing of its pipes, an instant before
// it can be waited for: then the tick is short.
void wait_for_news(const Children& children, int tick) {
  constexpr int kShortTick = 1;  // ms
  std::vector<pollfd> watched;
  bool one_is_ending = false;
  for (const auto& child : children) {
    for (int descriptor : {child->messages_descriptor(), child->words_descriptor()}) {
      if (descriptor >= 0) watched.push_back({descriptor, POLLIN, 0});
    }
    one_is_ending |= child->has_closed_its_pipes();
  }
  poll(watched.data(), watched.size(), one_is_ending ? kShortTick : tick);
}

class JobList : public JobFeed {
 public:
  explicit JobList(const std::vector<Job>& jobs) : jobs_(jobs) {}
  bool is_over() override { return next_ == jobs_.size(); }
  std::optional<Numbered> next() override {
    if (is_over()) return {};
    const std::size_t number = next_++;
    return Numbered{number, jobs_[number]};
  }

 private:
  const std::vector<Job>& jobs_;
  std::size_t next_ = 0;
};

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

std::string sentence_of(const JobEnd& end, double limit) {
  const std::string words = end.last_words.empty() ? "" : fmt::format("; its last words: {}", end.last_words);
  switch (end.how) {
    case Ending::finished:
      return "ended without an answer";
    case Ending::refused:
      return end.text;
    case Ending::threw:
      return fmt::format("ended by an exception: {}{}", end.text, words);
    case Ending::killed:
      return fmt::format("killed by SIG{} ({}){}", sigabbrev_np(end.code) ? sigabbrev_np(end.code) : "?",
                         sigdescr_np(end.code) ? sigdescr_np(end.code) : "no known signal", words);
    case Ending::exited:
      return fmt::format("called exit({}) before it had answered{}", end.code, words);
    case Ending::timed_out:
      return fmt::format("no result within the limit of {:g} s{}", limit, words);
  }
  return "";
}

void run_jobs(const std::vector<Job>& jobs, int at_once,
              const std::function<void(std::size_t, const std::string&)>& on_message,
              const std::function<void(std::size_t, const JobEnd&)>& on_end) {
  JobList list(jobs);
  run_jobs(list, at_once, on_message, on_end);
}

void run_jobs(JobFeed& feed, int at_once, const std::function<void(std::size_t, const std::string&)>& on_message,
              const std::function<void(std::size_t, const JobEnd&)>& on_end) {
  const SignalWatch watch;
  Children children;
  while (!feed.is_over() || !children.empty()) {
    while (static_cast<int>(children.size()) < at_once) {
      const auto next = feed.next();
      if (!next) break;
      children.push_back(std::make_unique<Child>(next->job, next->number));
    }
    wait_for_news(children, feed.longest_wait());
    if (caught_signal) {
      children.clear();
      throw Interrupted{caught_signal};
    }
    for (auto& child : children) {
      const bool has_ended = child->has_ended();  // asked first: what it said before its end is then all there
      child->listen(on_message);
      if (!has_ended && !child->is_late()) continue;
      if (!has_ended) child->stop();
      on_end(child->job, child->end());
      child.reset();
    }
    std::erase(children, nullptr);
  }
}

}  // namespace rigor
