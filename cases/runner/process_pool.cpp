#include "cases/runner/process_pool.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cstring>
#include <memory>

#include "cases/runner/forked_child.h"
#include "cases/runner/platform/platform.h"

namespace rigor::inline runner {
namespace {

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
  the_platform().wait_for_input(watched, one_is_ending ? kShortTick : tick);
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
  const std::unique_ptr<SignalWatch> watch = the_platform().watch_signals();
  Children children;
  while (!feed.is_over() || !children.empty()) {
    while (static_cast<int>(children.size()) < at_once) {
      const auto next = feed.next();
      if (!next) break;
      children.push_back(std::make_unique<ForkedChild>(next->job, next->number));
    }
    wait_for_news(children, feed.longest_wait());
    beat();
    if (const int signal = watch->caught()) {
      children.clear();
      throw Interrupted{signal};
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

}  // namespace rigor::inline runner
