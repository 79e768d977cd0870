// Finds in a text what the TOML library (toml++ 3.3) must not be given, so that it is refused before it gets there:
// - a dotted key of so many parts, a.a.a.a..., that the library, which walks the nested tables that it makes of one
//   recursively, would run out of stack: it refuses values nested deeper than TOML_MAX_NESTED_VALUES by itself, but as
//   Debian ships it a key of 100,000 parts ends the process;
// - a table's header that begins with no key, as "[ #": the library takes for granted that one follows;
// - a character beyond ASCII where it looks for white space, outside of strings and comments or behind a line's end
//   that a string escapes: its table of white space has no answer for many of them. TOML allows none but in the last
//   place.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace rigor {

inline constexpr int kDeepestKey = 32;  // parts; a case file needs three

struct TextFault {
  long line, column;  // from 1; the column counts characters
  std::string what;   // "found ...", or "is not TOML: found ..."
};

// The first such place; none if the text may be given to the library, which still has to say whether it is TOML.
std::optional<TextFault> beyond_library(std::string_view text);

}  // namespace rigor
