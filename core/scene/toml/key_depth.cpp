#include "core/scene/toml/key_depth.h"

#include <algorithm>

namespace rigor {
namespace {

// The end of the comment that begins at `at`: its line feed.
std::size_t comment_end(std::string_view text, std::size_t at) { return std::min(text.find('\n', at), text.size()); }

// The position behind the string whose first quote is at `at`. A string that does not end, or goes over the line's end
// without three quotes, is malformed: the library stops there, and whatever is said of the rest is still an error.
std::size_t string_end(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string_view three = quote == '"' ? R"(""")" : "'''";
  const bool many_lines = text.substr(at, 3) == three;
  for (std::size_t i = at + (many_lines ? 3 : 1); i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\') {
      ++i;
    } else if (many_lines && text.substr(i, 3) == three) {
      i += 3;
      while (i < text.size() && text[i] == quote) ++i;  // up to two quotes may stand before the closing three
      return i;
    } else if (!many_lines && (text[i] == quote || text[i] == '\n')) {
      return i + 1;
    }
  }
  return text.size();
}

TextPosition position_of(std::string_view text, std::size_t at) {
  const std::string_view before = text.substr(0, at);
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
  const auto is_character = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; };
  return {std::count(before.begin(), before.end(), '\n') + 1,
          std::count_if(before.begin() + static_cast<std::ptrdiff_t>(line_start), before.end(), is_character) + 1};
}

}  // namespace

std::optional<TextPosition> key_too_deep(std::string_view text) {
  constexpr std::string_view kEndsKey = "=,{}[]\n";
  int parts = 1;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == '#') {
      i = comment_end(text, i);
    } else if (text[i] == '"' || text[i] == '\'') {
      i = string_end(text, i);
    } else {
      if (kEndsKey.find(text[i]) != std::string_view::npos) parts = 1;
      if (text[i] == '.' && ++parts > kDeepestKey) return position_of(text, i);
      ++i;
    }
  }
  return std::nullopt;
}

}  // namespace rigor
