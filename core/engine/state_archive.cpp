#include "core/engine/state_archive.h"

#include <cstring>

#include "core/base/error.h"

namespace rigor::inline engine {

void StateArchive::refuse_size() {
  throw InputError("the saved state does not fit this world: one of its lists has another length");
}

void StateArchive::end() const {
  if (restores_ && !saved_.empty()) refuse_size();
}

void StateArchive::raw(void* data, std::size_t bytes) {
  if (bytes == 0) return;
  if (!restores_) {
    bytes_.append(static_cast<const char*>(data), bytes);
    return;
  }
  if (bytes > saved_.size()) refuse_size();
  std::memcpy(data, saved_.data(), bytes);
  saved_.remove_prefix(bytes);
}

void StateArchive::flag(bool& it) {
  std::uint8_t byte = it ? 1 : 0;
  raw(&byte, 1);
  if (byte > 1) refuse_size();
  it = byte == 1;
}

// Each element of a list that grows takes a byte at least, so damaged bytes cannot ask for more memory than they have.
std::size_t StateArchive::size(std::size_t own) {
  std::uint64_t count = own;
  raw(&count, sizeof count);
  if (restores_ && count > saved_.size()) refuse_size();
  return count;
}

void StateArchive::fixed_size(std::size_t own) {
  std::uint64_t count = own;
  raw(&count, sizeof count);
  if (count != own) refuse_size();
}

void StateArchive::check_room(std::int64_t rows, std::int64_t columns) const {
  const auto room = static_cast<std::int64_t>(saved_.size() / sizeof(double));
  if (rows < 0 || columns < 0 || rows > room || columns > room || rows * columns > room) refuse_size();
}

std::size_t StateArchive::in_range(std::int64_t place, std::size_t size) {
  if (place >= static_cast<std::int64_t>(size)) refuse_size();
  return static_cast<std::size_t>(place);
}

}  // namespace rigor::inline engine
