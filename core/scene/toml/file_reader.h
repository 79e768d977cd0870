// Reads a text file that a person named, whole, or says why it cannot be read.
#pragma once

#include <string>

namespace rigor::inline scene {

inline constexpr std::size_t kLargestFile = std::size_t{64} << 20;  // bytes; beyond it no case file was meant

// Throws InputError, beginning with the path, unless it is a readable regular file of at most kLargestFile bytes.
std::string read_text_file(const std::string& path);

}  // namespace rigor::inline scene
