#include "cases/cli/progress/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "cases/cli/output.h"
#include "cases/cli/progress/durations.h"
#include "cases/runner/process_pool.h"

namespace rigor::inline cli {
namespace {

// s between two lines. RIGOR_PROGRESS_SECONDS changes it, for tests.
double seconds_between_lines() {
  constexpr double kUsual = 10;
  const char* said = std::getenv("RIGOR_PROGRESS_SECONDS");
  const double seconds = said ? std::atof(said) : 0;
  return seconds > 0 ? seconds : kUsual;
}

// A variable set to nothing counts as not set (no-color.org).
bool wants_colour() {
  const char* no_colour = std::getenv("NO_COLOR");
  return no_colour == nullptr || *no_colour == '\0';
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Progress::Progress(std::string what)
    : what_(std::move(what)),
      is_terminal_(isatty(STDERR_FILENO) == 1),
      has_colour_(is_terminal_ && wants_colour()),
      start_(std::chrono::steady_clock::now()),
      last_line_(start_) {
  if (!is_terminal_) set_heartbeat([this] { print_line_if_due(); });
}

Progress::~Progress() {
  if (is_terminal_) {
    std::fputs(fmt::format("\r{:60}\r", "").c_str(), stderr);
  } else {
    set_heartbeat({});
  }
}

void Progress::show(std::size_t done, std::size_t all) {
  constexpr double kAtOnce = 0.3;  // s: what is done so early comes from the journal of an interrupted run
  done_ = done, all_ = all;
  if (seconds_since(start_) < kAtOnce) kept_ = done;
  if (is_terminal_) show_bar();
  if (!is_terminal_) print_line_if_due();
}

void Progress::show_bar() const {
  constexpr std::size_t kWidth = 40;
  // Not fmt::print, which throws if stderr cannot be written.
  if (all_ == 0) {
    std::fputs(fmt::format("\r{} {}", done_, what_).c_str(), stderr);
    return;
  }
  const std::size_t filled = done_ * kWidth / all_;
  std::string bar(filled, '#');
  if (has_colour_) bar = "\x1b[32m" + bar + "\x1b[0m";
  std::fputs(fmt::format("\r[{}{}] {}/{}", bar, std::string(kWidth - filled, '.'), done_, all_).c_str(), stderr);
}

void Progress::print_line_if_due() {
  static const double between = seconds_between_lines();
  if (seconds_since(last_line_) < between) return;
  last_line_ = std::chrono::steady_clock::now();
  const double seconds = seconds_since(start_);
  say(left_ ? progress_text(what_, done_, all_, seconds, left_(seconds))
            : progress_text(what_, done_, all_, seconds, kept_));
}

std::string progress_text(const std::string& what, std::size_t done, std::size_t all, double seconds,
                          const std::optional<Estimate>& left) {
  const std::string text = fmt::format("{} of {} {} after {}", done, all, what, duration_text(seconds));
  if (done >= all) return text;
  return left ? fmt::format("{}; {} left", text, duration_range(left->least, left->most))
              : text + "; the time left is not known yet";
}

std::string progress_text(const std::string& what, std::size_t done, std::size_t all, double seconds,
                          std::size_t kept) {
  const std::string so_far = duration_text(seconds);
  if (all == 0) return fmt::format("{} {} after {}", done, what, so_far);
  const std::string text = fmt::format("{} of {} {} after {}", done, all, what, so_far);
  if (done <= kept || done >= all) return text;
  // The cells that are left may be dearer than those that are done.
  constexpr double kDearer = 2;
  const double left = seconds * static_cast<double>(all - done) / static_cast<double>(done - kept);
  return fmt::format("{}; {} left", text, duration_range(left, kDearer * left));
}

}  // namespace rigor::inline cli
