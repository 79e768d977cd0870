#include "cases/cli/output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "core/base/error.h"

namespace rigor::inline cli {
namespace {

// The length in bytes of the UTF-8 character at `at`; 0 if none begins there.
std::size_t length_of_character(const std::string& text, std::size_t at) {
  const unsigned char first = text[at];
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xc2 ? 0
                             : first < 0xe0 ? 2
                             : first < 0xf0 ? 3
                             : first < 0xf5 ? 4
                                            : 0;
  if (length == 0 || text.size() - at < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((static_cast<unsigned char>(text[at + i]) & 0xc0) != 0x80) return 0;
  }
  return length;
}

// C0, DEL and C1. Some terminals also obey single bytes of C1, which are no UTF-8.
bool is_control(const std::string& text, std::size_t at) {
  const unsigned char first = text[at];
  return first < 0x20 || first == 0x7f || (first == 0xc2 && static_cast<unsigned char>(text[at + 1]) < 0xa0);
}

// "\x1b" for an escape, "\xc2\x9b" for a control character of two bytes.
std::string escaped(const std::string& character) {
  std::string text;
  for (const char byte : character) text += fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
  return text;
}

}  // namespace

void take_standard_streams() {
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
    if (fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
    if (open("/dev/null", O_RDWR) != descriptor) throw std::runtime_error("/dev/null cannot be opened");
  }
}

std::string harmless(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = length_of_character(text, at);
    const std::string character = text.substr(at, std::max<std::size_t>(length, 1));
    const bool is_good = length > 0 && (character == "\n" || !is_control(text, at));
    out += is_good ? character : character == "\t" ? "\\t" : escaped(character);
    at += character.size();
  }
  return out;
}

void print(const std::string& text) {
  static const bool is_terminal = isatty(STDOUT_FILENO) == 1;
  const std::string shown = is_terminal ? harmless(text) : text;
  errno = 0;
  const bool is_written =
      std::fwrite(shown.data(), 1, shown.size(), stdout) == shown.size() && std::fflush(stdout) == 0;
  if (!is_written && errno != EPIPE)
    throw std::runtime_error(std::string("stdout cannot be written: ") + std::strerror(errno));
}

void write_file(const std::string& option, const std::string& file, const std::string& text) {
  const std::string growing = file + ".partial";
  std::ofstream stream(growing, std::ios::binary);
  stream << text;
  stream.close();
  std::error_code error;
  if (stream) std::filesystem::rename(growing, file, error);
  if (stream && !error) return;
  const std::string why = error ? error.message() : std::strerror(errno);
  std::filesystem::remove(growing, error);
  throw InputError(fmt::format("{} {}: cannot be written: {}", option, file, why));
}

void say(const std::string& line) {
  const std::string shown = "rigor: " + harmless(line) + "\n";
  std::fwrite(shown.data(), 1, shown.size(), stderr);
}

}  // namespace rigor::inline cli
