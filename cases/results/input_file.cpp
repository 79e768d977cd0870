#include "cases/results/input_file.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/base/error.h"

namespace rigor::inline results {

std::string read_input_file(const std::string& path, const std::string& what) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  const auto refuse = [&](const std::string& fault) {
    throw InputError(fmt::format("{}: {}; give {}", path, fault, what));
  };
  if (!std::filesystem::exists(status)) refuse("cannot be read");
  if (!std::filesystem::is_regular_file(status)) refuse("is not a regular file");
  if (std::filesystem::file_size(path, error) > kLargestInput)
    refuse(fmt::format("is larger than {} bytes", kLargestInput));
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) refuse("cannot be read");
  return text;
}

}  // namespace rigor::inline results
