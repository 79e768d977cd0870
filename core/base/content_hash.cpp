#include "core/base/content_hash.h"

#include <bit>
#include <cstring>
#include <fstream>

namespace rigor {

std::uint64_t hash_of_file(const std::string& path, std::uint64_t so_far) {
  std::ifstream file(path, std::ios::binary);
  std::string chunk(1 << 20, '\0');
  while (file) {
    file.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    const auto size = static_cast<std::size_t>(file.gcount());
    std::size_t at = 0;
    for (std::uint64_t word = 0; at + sizeof word <= size; at += sizeof word) {
      std::memcpy(&word, chunk.data() + at, sizeof word);
      // A product carries upwards only: turned, the word's high bits reach the low ones.
      so_far = std::rotl((so_far ^ word) * 1099511628211u, 29);
    }
    so_far = content_hash({chunk.data() + at, size - at}, so_far);
  }
  return so_far;
}

}  // namespace rigor
