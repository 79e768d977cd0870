// Where a place that the TOML library names stands in the text.
#pragma once

#include <cstddef>
#include <string>

namespace rigor::inline scene {

// The library counts lines and columns from 1, and columns in characters of UTF-8.
inline std::size_t offset_of(const std::string& text, std::size_t line, std::size_t column) {
  std::size_t at = 0;
  for (std::size_t n = 1; n < line; ++n) at = text.find('\n', at) + 1;
  for (std::size_t n = 1; n < column && at < text.size(); ++n) {
    ++at;
    while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80) ++at;
  }
  return at;
}

}  // namespace rigor::inline scene
