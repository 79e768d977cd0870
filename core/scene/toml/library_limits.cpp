#include "core/scene/toml/library_limits.h"

#include <fmt/format.h>

#include <algorithm>

namespace rigor::inline scene {
namespace {

// A character of two bytes or three: those of four have no place in the library's tables. What is not UTF-8 the library
// refuses itself.
bool is_beyond_ascii(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  return byte(at) >= 0xc2 && byte(at) < 0xf0 && (byte(at + 1) & 0xc0) == 0x80;
}

bool is_space(char c) { return c == ' ' || c == '\t'; }

bool begins_key(char c) {
  const bool is_bare =
      (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  return is_bare || c == '"' || c == '\'';
}

// Scans a text as the library does, up to the first malformed part. The library stops there, and reports an error
// whatever follows.
class Scan {
 public:
  explicit Scan(std::string_view text) : text_(text) {
    if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;  // a byte order mark, which the library passes over
  }

  std::optional<TextFault> first_fault() {
    while (at_ < text_.size() && !fault_) pass_one();
    return fault_;
  }

 private:
  void pass_one() {
    const char c = text_[at_];
    if (c == '#') {
      at_ = std::min(text_.find('\n', at_), text_.size());
    } else if (c == '"' || c == '\'') {
      begins_line_ = false;
      pass_string(c);
    } else if (is_beyond_ascii(text_, at_)) {
      found_fault(at_, "is not TOML: found a character outside of strings and comments that is not ASCII");
    } else if (c == '[' && begins_line_ && depth_ == 0) {
      pass_header_start();
    } else {
      pass_plain(c);
    }
  }

  void pass_plain(char c) {
    constexpr std::string_view kEndsKey = "=,{}[]\n";
    if (kEndsKey.find(c) != std::string_view::npos) parts_ = 1;
    if (c == '.' && ++parts_ > kDeepestKey) {
      return found_fault(at_, fmt::format("found a key of more than {} parts", kDeepestKey));
    }
    if (c == '[' || c == '{') ++depth_;
    if (c == ']' || c == '}') --depth_;
    if (c == '\n') begins_line_ = true;
    if (c != '\n' && c != '\r' && !is_space(c)) begins_line_ = false;
    ++at_;
  }

  void pass_header_start() {
    begins_line_ = false;
    parts_ = 1;
    int brackets = 0;
    for (; brackets < 2 && at_ < text_.size() && text_[at_] == '['; ++brackets) ++at_, ++depth_;
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
    // A header that ends here, by its bracket or with the text, and one whose brackets stand apart the library refuses.
    if (at_ == text_.size() || text_[at_] == ']' || begins_key(text_[at_])) return;
    if (text_[at_] == '[' && brackets == 1) return;
    const char c = text_[at_];
    const bool is_printable = c > ' ' && c < 0x7f;
    found_fault(at_, fmt::format("is not TOML: found {} where the name of a table begins",
                                 is_printable ? fmt::format("'{}'", c) : "a character that no name has"));
  }

  // A string that does not end, or goes over the line's end without three quotes, is malformed.
  void pass_string(char quote) {
    const std::string_view three = quote == '"' ? R"(""")" : "'''";
    const bool many_lines = text_.substr(at_, 3) == three;
    for (std::size_t i = at_ + (many_lines ? 3 : 1); i < text_.size(); ++i) {
      if (quote == '"' && text_[i] == '\\') {
        i = many_lines ? behind_escape(i) : i + 1;
      } else if (many_lines && text_.substr(i, 3) == three) {
        i += 3;
        while (i < text_.size() && text_[i] == quote) ++i;  // up to two quotes may stand before the closing three
        at_ = i;
        return;
      } else if (!many_lines && (text_[i] == quote || text_[i] == '\n')) {
        at_ = text_[i] == '\n' ? i : i + 1;
        return;
      }
    }
    at_ = text_.size();
  }

  // The last character of an escape that begins at i, with all white space behind an escaped end of a line.
  std::size_t behind_escape(std::size_t i) {
    const auto is_blank = [](char c) { return is_space(c) || c == '\n' || c == '\r'; };
    ++i;
    const bool is_line_end = i < text_.size() && is_blank(text_[i]);
    while (is_line_end && i + 1 < text_.size() && is_blank(text_[i + 1])) ++i;
    if (is_line_end && is_beyond_ascii(text_, i + 1)) {
      found_fault(
          i + 1,
          "found a character that is not ASCII right behind a line's end that a string escapes; begin that line "
          "by another");
    } else if (is_beyond_ascii(text_, i)) {
      found_fault(i, "is not TOML: found a backslash before a character that is not ASCII");
    }
    return i;
  }

  void found_fault(std::size_t at, std::string what) {
    if (fault_) return;
    const std::string_view before = text_.substr(0, at);
    const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
    const auto is_character = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; };
    fault_ = {std::count(before.begin(), before.end(), '\n') + 1,
              std::count_if(before.begin() + static_cast<std::ptrdiff_t>(line_start), before.end(), is_character) + 1,
              std::move(what)};
  }

  std::string_view text_;
  std::size_t at_ = 0;
  bool begins_line_ = true;
  int depth_ = 0;  // of brackets
  int parts_ = 1;  // of the key
  std::optional<TextFault> fault_;
};

}  // namespace

std::optional<TextFault> beyond_library(std::string_view text) { return Scan(text).first_fault(); }

}  // namespace rigor::inline scene
