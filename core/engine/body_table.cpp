#include "core/engine/body_table.h"

#include <algorithm>

namespace rigor {

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
  const int count = has_rotation_ ? 22 : 13;
  for (int c = 0; c < count; ++c) std::copy_n(source.column(c), size_, columns().column(c));
  return *this;
}

}  // namespace rigor
