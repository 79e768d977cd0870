#include "core/engine/body_table.h"

#include <algorithm>

namespace rigor {

void copy_columns(BodyColumns from, MutableBodyColumns to) {
  const int count = to.has_rotation() ? 22 : 13;
  for (int c = 0; c < count; ++c) std::copy_n(from.column(c), to.size(), to.column(c));
}

void BodyTable::resize(std::size_t size, bool has_rotation) {
  size_ = size;
  has_rotation_ = has_rotation;
  stride_ = column_stride(size);
  data_.assign(stride_ * (has_rotation ? 22 : 13), 0.0);
}

BodyTable& BodyTable::operator=(BodyColumns source) {
  if (size_ != source.size() || has_rotation_ != source.has_rotation() || data_.empty()) {
    resize(source.size(), source.has_rotation());
  }
  copy_columns(source, columns());
  return *this;
}

}  // namespace rigor
