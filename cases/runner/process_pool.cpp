#include "cases/runner/process_pool.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <memory>

#include "cases/runner/forked_child.h"

namespace rigor {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t caught_signal = 0;

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

struct Heartbeat {
  std::function<void()> call = {};
  pid_t owner = 0;
};
Heartbeat& current_heartbeat() {
  static Heartbeat heartbeat;
  return heartbeat;
}

void beat() {
  const Heartbeat& heartbeat = current_heartbeat();
  if (heartbeat.call && heartbeat.owner == getpid()) heartbeat.call();
}

using Children = std::vector<std::unique_ptr<ForkedChild>>;

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

void set_heartbeat(std::function<void()> heartbeat) { current_heartbeat() = {std::move(heartbeat), getpid()}; }

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
      children.push_back(std::make_unique<ForkedChild>(next->job, next->number));
    }
    wait_for_news(children, feed.longest_wait());
    beat();
    if (caught_signal) {
      children.clear();
      throw Interrupted{caught_signal};
    }
    for (auto& child : children) {
      const bool has_ended = child->has_ended();  // checked first, so that all output before its end is available
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
