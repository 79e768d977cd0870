#include "core/engine/body_table.h"

#include <algorithm>
#include <memory_resource>

namespace rigor::inline engine {
namespace {

// Never destroyed, because its contents may live as long as the program.
std::pmr::memory_resource& pool() {
  constexpr std::size_t kLargest = 1 << 16;  // bytes: six hundred bodies
  static auto* all =
      new std::pmr::synchronized_pool_resource({.max_blocks_per_chunk = 0, .largest_required_pool_block = kLargest});
  return *all;
}

}  // namespace

void* take_from_pool(std::size_t bytes) { return pool().allocate(bytes, alignof(double)); }
void give_to_pool(void* place, std::size_t bytes) { pool().deallocate(place, bytes, alignof(double)); }

void copy_columns(BodyColumns from, MutableBodyColumns to) {
  const int count = to.has_rotation() ? 22 : 13;
  for (int c = 0; c < count; ++c) std::copy_n(from.column(c), to.size(), to.column(c));
}

template <bool kIsPadded>
void BodyTableOf<kIsPadded>::resize(std::size_t size, bool has_rotation) {
  size_ = size;
  has_rotation_ = has_rotation;
  stride_ = kIsPadded ? column_stride(size) : size;
  data_.assign(stride_ * (has_rotation ? 22 : 13), 0.0);
}

template <bool kIsPadded>
BodyTableOf<kIsPadded>& BodyTableOf<kIsPadded>::operator=(BodyColumns source) {
  if (size_ != source.size() || has_rotation_ != source.has_rotation() || data_.empty()) {
    resize(source.size(), source.has_rotation());
  }
  copy_columns(source, columns());
  return *this;
}

template class BodyTableOf<true>;
template class BodyTableOf<false>;

}  // namespace rigor::inline engine
