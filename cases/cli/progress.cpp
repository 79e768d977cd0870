#include "cases/cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace rigor {
namespace {

// A variable set to nothing counts as not set (no-color.org).
bool wants_colour() {
  const char* no_colour = std::getenv("NO_COLOR");
  return no_colour == nullptr || *no_colour == '\0';
}

}  // namespace

Progress::Progress() : is_terminal_(isatty(STDERR_FILENO) == 1), has_colour_(is_terminal_ && wants_colour()) {}

Progress::~Progress() {
  if (is_terminal_) std::fputs(fmt::format("\r{:60}\r", "").c_str(), stderr);
}

void Progress::show(std::size_t done, std::size_t all) {
  if (!is_terminal_) return;
  constexpr std::size_t kWidth = 40;
  const std::size_t filled = all == 0 ? kWidth : done * kWidth / all;
  std::string bar(filled, '#');
  if (has_colour_) bar = "\x1b[32m" + bar + "\x1b[0m";
  // Not fmt::print, which throws where stderr cannot be written.
  std::fputs(fmt::format("\r[{}{}] {}/{}", bar, std::string(kWidth - filled, '.'), done, all).c_str(), stderr);
}

}  // namespace rigor
