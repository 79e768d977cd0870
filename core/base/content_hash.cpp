#include "core/base/content_hash.h"

#include <bit>
#include <cstring>
#include <fstream>

namespace rigor {
namespace {

// As a lane of Appleby's MurmurHash3 takes a word in.
std::uint64_t mixed_in(std::uint64_t so_far, std::uint64_t word) {
  word = std::rotl(word * 0x87c37b91114253d5u, 31) * 0x4cf5ad432745937fu;
  return std::rotl(so_far ^ word, 27) * 5 + 0x52dce729u;
}

}  // namespace

std::uint64_t hash_of_file(const std::string& path, std::uint64_t so_far) {
  std::ifstream file(path, std::ios::binary);
  std::string chunk(1 << 20, '\0');
  while (file) {
    file.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    const auto size = static_cast<std::size_t>(file.gcount());
    std::size_t at = 0;
    for (std::uint64_t word = 0; at + sizeof word <= size; at += sizeof word) {
      std::memcpy(&word, chunk.data() + at, sizeof word);
      so_far = mixed_in(so_far, word);
    }
    so_far = content_hash({chunk.data() + at, size - at}, so_far);
  }
  return so_far;
}

}  // namespace rigor
