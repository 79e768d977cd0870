// The constants of the bodies of a system, in columns for the kernels (kernels/kernels.h).
#pragma once

#include <algorithm>
#include <memory>

#include "core/base/math.h"
#include "core/base/thread_pool.h"
#include "core/dynamics/kernels/kernels.h"
#include "core/engine/columns.h"

namespace rigor::inline dynamics {

struct Inertia;

class BodyConstants {
 public:
  BodyConstants() = default;
  BodyConstants(const std::vector<Inertia>& bodies, const Vec3& gravity);

  std::size_t size() const { return size_; }
  // All bodies at once. Valid as long as this object stays where it is.
  Bodies all() const;
  // Calls pass(block) for blocks that fit a first-level cache with all data of a method. Passes that need nothing from
  // other bodies should follow each other on each block.
  template <typename Pass>
  void for_each_block(const Pass& pass) const {
    for_each_share(size_, [&](std::size_t first, std::size_t last) {
      Bodies block = all();
      for (block.begin = first; block.begin < last; block.begin += kBlock) {
        block.end = std::min(block.begin + kBlock, last);
        pass(static_cast<const Bodies&>(block));
      }
    });
  }

  // More than one thread share the passes, where there are bodies enough for it.
  void use_threads(int count);
  // For methods that have more to do with each body than a pass; null: this thread alone.
  const std::shared_ptr<ThreadPool>& thread_pool() const { return thread_pool_; }
  // Calls pass(first, last) for each thread's share of `rows` bodies, springs or other rows, in that thread.
  template <typename Pass>
  void for_each_share(std::size_t rows, const Pass& pass) const {
    if (!thread_pool_ || size_ < kWorthSharing) return pass(0, rows);
    const std::size_t share = (rows / thread_pool_->members() / kBlock + 1) * kBlock;
    thread_pool_->run([&](std::size_t member) {
      const std::size_t first = member * share;
      if (first < rows) pass(first, std::min(first + share, rows));
    });
  }

 private:
  static constexpr std::size_t kBlock = 64;  // rows
  // With fewer bodies a pass takes less time than threads need to meet, some microseconds.
  static constexpr std::size_t kWorthSharing = 8192;
  void set_body(std::size_t i, const Inertia& body);
  void set_symmetric(ConstantColumn column, std::size_t i, const Mat3& m);

  Columns columns_;
  std::shared_ptr<ThreadPool> thread_pool_;  // null: this thread alone
  std::size_t size_ = 0;
  Vec3 gravity_ = Vec3::Zero();
  bool has_fixed_ = false, diagonal_ = true, principal_ = true, round_ = true;
};

}  // namespace rigor::inline dynamics
