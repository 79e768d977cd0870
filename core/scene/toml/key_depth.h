// Finds a dotted key of so many parts, a.a.a.a..., that the TOML library, which walks the nested tables that it makes
// of one recursively, would run out of stack. It limits the nesting of values itself, but not this.
#pragma once

#include <optional>
#include <string_view>

namespace rigor {

inline constexpr int kDeepestKey = 32;  // parts; a case file needs three

struct TextPosition {
  long line, column;  // from 1; the column counts characters
};

// Where the first key with more than kDeepestKey parts passes that depth.
std::optional<TextPosition> key_too_deep(std::string_view text);

}  // namespace rigor
