// Data on stdout. Whoever reads it may stop reading: that is no fault.
#pragma once

#include <string>

namespace rigor {

struct ReaderGone {};

// Throws ReaderGone if stdout is a pipe that nobody reads any more, std::runtime_error if it cannot be written.
void print(const std::string& text);

}  // namespace rigor
