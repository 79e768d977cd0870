// Finds texts that the TOML library (toml++ 3.3) cannot handle, so that they are refused first:
// - a dotted key with very many parts, a.a.a.a.... The library walks the nested tables of the key recursively and would
//   exhaust the stack. It refuses values nested deeper than TOML_MAX_NESTED_VALUES itself, but Debian's build crashes
//   on a key of 100,000 parts;
// - a table header without a key, as "[ #": the library assumes that one follows;
// - a character beyond ASCII where it expects white space, outside of strings and comments, or after a line's end that
//   a string escapes. Its table of white space has no entry for many of them. TOML allows them only in the last place.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace rigor::inline scene {

inline constexpr int kDeepestKey = 32;  // parts; a case file needs three

struct TextFault {
  long line, column;  // from 1; the column counts characters
  std::string what;   // "found ...", or "is not TOML: found ..."
};

// The first such place; none if the text may be given to the library, which still has to say whether it is TOML.
std::optional<TextFault> beyond_library(std::string_view text);

}  // namespace rigor::inline scene
