// What does not change about the bodies of a system, in columns for the kernels (kernels/kernels.h).
#pragma once

#include "core/dynamics/kernels/kernels.h"
#include "core/engine/columns.h"
#include "core/math.h"

namespace rigor {

struct Inertia;

class BodyConstants {
 public:
  BodyConstants() = default;
  BodyConstants(const std::vector<Inertia>& bodies, const Vec3& gravity);

  std::size_t size() const { return size_; }
  // All bodies at once. Valid as long as this object stays where it is.
  Bodies all() const;
  // Calls pass(block) for blocks that fit a cache of the first level with all that a method keeps about them: passes
  // that need nothing from other bodies should follow each other on each block.
  template <typename Pass>
  void for_each_block(const Pass& pass) const {
    constexpr std::size_t kRows = 64;
    Bodies block = all();
    for (block.begin = 0; block.begin < size_; block.begin += kRows) {
      block.end = block.begin + kRows < size_ ? block.begin + kRows : size_;
      pass(static_cast<const Bodies&>(block));
    }
  }

 private:
  void set_body(std::size_t i, const Inertia& body);
  void set_symmetric(ConstantColumn column, std::size_t i, const Mat3& m);

  Columns columns_;
  std::size_t size_ = 0;
  Vec3 gravity_ = Vec3::Zero();
  bool has_fixed_ = false, diagonal_ = true, principal_ = true;
};

}  // namespace rigor
