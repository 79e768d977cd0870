// Writes to stdout and stderr. A reader that stops or is absent changes no exit code.
#pragma once

#include <string>

namespace rigor::inline cli {

// Opens /dev/null on descriptors 0 to 2 that are closed. Otherwise the next file or pipe would become a standard
// stream. Throws std::runtime_error if that fails.
void take_standard_streams();

// The text with each character that a terminal would obey as an escape, "\x1b". New lines stay.
std::string harmless(const std::string& text);

// Prints data on stdout, unchanged unless stdout is a terminal. Throws std::runtime_error if it cannot be written,
// except when nobody reads it.
void print(const std::string& text);

// Prints text for people to read.
inline void print_table(const std::string& text) { print(harmless(text)); }

// Writes the file as a whole, or leaves an old one as it was. Throws InputError that names `option`.
void write_file(const std::string& option, const std::string& file, const std::string& text);

// Prints a line on stderr that begins with "rigor: ". Never throws.
void say(const std::string& line);

}  // namespace rigor::inline cli
