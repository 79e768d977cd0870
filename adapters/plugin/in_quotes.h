// What an engine from outside has said, for a message: nothing in it that a terminal would obey, cut where it is long.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace rigor::inline adapters {

inline std::string in_quotes(std::string_view text, std::size_t longest = 200) {
  std::string out = "'";
  for (const char c : text.substr(0, longest)) {
    const bool is_plain = c >= ' ' && c <= '~';
    out += is_plain ? std::string(1, c) : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  }
  return out + (text.size() > longest ? fmt::format("...' ({} bytes)", text.size()) : "'");
}

}  // namespace rigor::inline adapters
