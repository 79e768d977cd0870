#include "core/scene/toml/file_reader.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/base/error.h"

namespace rigor::inline scene {
namespace {

namespace fs = std::filesystem;

// Asked before the file is opened, for opening a pipe would wait for its other end.
void check_is_file(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) throw InputError(fmt::format("{}: there is no such file", path));
  if (error) throw InputError(fmt::format("{}: cannot be read: {}", path, error.message()));
  if (fs::is_directory(status)) throw InputError(fmt::format("{}: is a folder, not a file", path));
  if (!fs::is_regular_file(status)) throw InputError(fmt::format("{}: is not a regular file", path));
}

}  // namespace

std::string read_text_file(const std::string& path) {
  check_is_file(path);
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text;
  // What is read is counted, rather than the size asked for: that of a file under /proc is 0.
  for (std::string block(std::size_t{1} << 16, '\0'); file;) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    text.append(block, 0, static_cast<std::size_t>(file.gcount()));
    if (text.size() > kLargestFile) {
      throw InputError(
          fmt::format("{}: is larger than {} MiB, the largest file that is read", path, kLargestFile >> 20));
    }
  }
  if (!file.eof()) {
    throw InputError(fmt::format("{}: cannot be read: {}", path, errno ? std::strerror(errno) : "reading failed"));
  }
  return text;
}

}  // namespace rigor::inline scene
