// Fowler, Noll and Vo's hash FNV-1a of 64 bits: it tells contents apart and notices damage, it does not guard against
// an attacker.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace rigor {

inline constexpr std::uint64_t kHashOfNothing = 14695981039346656037u;

// `so_far` is the hash of all bytes before these.
inline std::uint64_t content_hash(std::string_view bytes, std::uint64_t so_far = kHashOfNothing) {
  for (const char c : bytes) so_far = (so_far ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return so_far;
}

// Hash of a file's bytes, eight at a time, because a program and its libraries have a hundred megabytes. An unreadable
// file counts as empty.
std::uint64_t hash_of_file(const std::string& path, std::uint64_t so_far = kHashOfNothing);

}  // namespace rigor
