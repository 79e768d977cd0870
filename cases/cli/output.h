// What goes to stdout and stderr. Whoever reads it may stop reading or not be there at all: that is no fault, and no
// exit code hangs on it.
#pragma once

#include <string>

namespace rigor {

// Opens /dev/null on those of descriptors 0 to 2 that are closed, or the next file or pipe to be opened would be taken
// for a standard stream. Throws std::runtime_error if that cannot be done.
void take_standard_streams();

// The text with each character that a terminal would obey, new lines apart, turned into a blank.
std::string harmless(const std::string& text);

// Data on stdout: as it is, unless stdout is a terminal. Throws std::runtime_error if it cannot be written, for another
// reason than that nobody reads it.
void print(const std::string& text);

// For people to read, wherever it goes.
inline void print_table(const std::string& text) { print(harmless(text)); }

// A line on stderr, "rigor: " before it. Never throws: there is nowhere left to say it.
void say(const std::string& line);

}  // namespace rigor
