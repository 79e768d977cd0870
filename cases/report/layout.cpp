#include "cases/report/layout.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>

namespace rigor::inline report {
namespace {

// The end of the first `count` characters of a text.
std::size_t bytes_of(const std::string& text, std::size_t count) {
  std::size_t at = 0;
  for (; at < text.size(); ++at) {
    const bool begins_character = (text[at] & 0xc0) != 0x80;
    if (begins_character && count-- == 0) break;
  }
  return at;
}

}  // namespace

std::optional<std::size_t> terminal_width() {
  if (const char* columns = std::getenv("COLUMNS")) {
    std::size_t width = 0;
    const auto [end, error] = std::from_chars(columns, columns + std::strlen(columns), width);
    if (error == std::errc() && *end == '\0' && width > 0) return width;
  }
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  return {};
}

std::size_t console_width() {
  constexpr std::size_t kLeast = 60, kMost = 100;  // six numbers of a row need 56
  return std::clamp(terminal_width().value_or(kMost), kLeast, kMost);
}

std::string wrapped(const std::string& text, std::size_t indent) {
  constexpr std::size_t kLeast = 20;
  const std::size_t width = std::max(kLeast, console_width() - std::min(indent, console_width()));
  std::string out, rest = text;
  while (width_of(rest) > width) {
    const std::size_t end = bytes_of(rest, width);
    std::size_t at = rest.rfind(' ', end);
    if (at == std::string::npos || at == 0) at = rest.find(' ', end);
    if (at == std::string::npos) break;
    out += rest.substr(0, at) + "\n" + std::string(indent, ' ');
    rest.erase(0, at + 1);
  }
  return out + rest;
}

std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

}  // namespace rigor::inline report
