// How wide the tables on a terminal are.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace rigor::inline report {

// In characters: the variable COLUMNS, or the width of the terminal that stdout is. Nothing if neither is known.
std::optional<std::size_t> terminal_width();

// The width of tables: that of the terminal, from 60 to 100; 100 if it is not known.
std::size_t console_width();

// Breaks the text at spaces into lines of console_width(). Each line but the first begins with `indent` blanks; the
// caller has written as many characters before the first.
std::string wrapped(const std::string& text, std::size_t indent);

// The number of characters. One of UTF-8 may take several bytes.
std::size_t width_of(const std::string& text);

}  // namespace rigor::inline report
