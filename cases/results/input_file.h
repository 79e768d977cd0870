// A file that someone names on the command line or that stands beside an adapter, read whole.
#pragma once

#include <string>

namespace rigor::inline results {

// Larger than any results.json of a suite; stops the reading of an endless file.
inline constexpr std::size_t kLargestInput = std::size_t{1} << 30;  // bytes

// Throws InputError for what cannot be read, is no regular file (a folder, a device, a pipe), or is larger than that.
// `what` says what to give instead: "a results.json or a baseline".
std::string read_input_file(const std::string& path, const std::string& what);

}  // namespace rigor::inline results
