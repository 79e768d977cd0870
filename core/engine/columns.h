// Columns of doubles for kernels, which process several rows at once. Each column begins on a cache line, is padded to
// whole cache lines, and has the same distance to the next. Padding rows may be read and written; their values are
// meaningless.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace rigor::inline engine {

inline constexpr std::size_t kCacheLine = 64;  // bytes
inline constexpr std::size_t kRowsPerLine = kCacheLine / sizeof(double);

// Distance from the start of one column of `rows` doubles to the next [doubles]. It is an odd number of cache lines.
// With a power of two all columns would compete for the same few cache sets.
inline constexpr std::size_t column_stride(std::size_t rows) {
  return kRowsPerLine * ((rows + kRowsPerLine - 1) / kRowsPerLine | 1);
}

template <typename T>
struct CacheLineAllocator {
  using value_type = T;
  CacheLineAllocator() = default;
  template <typename U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}
  T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{kCacheLine}));
  }
  void deallocate(T* p, std::size_t) { ::operator delete (p, std::align_val_t{kCacheLine}); }
  bool operator==(const CacheLineAllocator&) const { return true; }
};
using AlignedDoubles = std::vector<double, CacheLineAllocator<double>>;

class Columns {
 public:
  Columns() = default;
  Columns(std::size_t columns, std::size_t rows) { resize(columns, rows); }

  void resize(std::size_t columns, std::size_t rows) {
    stride_ = column_stride(rows);
    data_.assign(columns * stride_, 0.0);
  }
  std::size_t stride() const { return stride_; }
  double* data() { return data_.data(); }
  const double* data() const { return data_.data(); }
  double* column(std::size_t c) { return data_.data() + c * stride_; }
  const double* column(std::size_t c) const { return data_.data() + c * stride_; }

 private:
  AlignedDoubles data_;
  std::size_t stride_ = 0;
};

}  // namespace rigor::inline engine
