// The motion of all bodies at one instant, as thirteen columns of doubles (a structure of arrays). An engine with
// matrix orientations has nine more columns. The core's state, an engine's snapshot and a trajectory's samples share
// this layout, so the core hands out its columns without a copy.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "core/base/math.h"
#include "core/engine/body_column.h"
#include "core/engine/columns.h"

namespace rigor::inline engine {

struct BodyState {
  Vec3 position = Vec3::Zero();          // m, p_WB
  Quat orientation = Quat::Identity();   // B to W, as the engine holds it: not normalised here
  Vec3 velocity = Vec3::Zero();          // m/s, in W
  Vec3 angular_velocity = Vec3::Zero();  // rad/s, in W
};

// In the order of the trajectory file.
inline constexpr std::array<const char*, 13> kColumnNames = {"px", "py", "pz", "qw", "qx", "qy", "qz",
                                                             "vx", "vy", "vz", "wx", "wy", "wz"};

// A view without ownership: column c of body i is column(c)[i]. Columns from kRotation on (row-major) exist only if
// has_rotation(). It is valid as long as its source.
template <typename Scalar>
class BodyColumnsOf {
 public:
  BodyColumnsOf() = default;
  // `stride` doubles lie between the starts of two columns.
  BodyColumnsOf(Scalar* first, std::size_t stride, std::size_t size, bool has_rotation)
      : first_(first), stride_(stride), size_(size), has_rotation_(has_rotation) {}

  std::size_t size() const { return size_; }
  std::size_t stride() const { return stride_; }
  bool has_rotation() const { return has_rotation_; }
  Scalar* column(int c) const { return first_ + c * stride_; }

  Vec3 position(std::size_t i) const { return vector(kPosition, i); }
  Vec3 velocity(std::size_t i) const { return vector(kVelocity, i); }
  Vec3 angular_velocity(std::size_t i) const { return vector(kAngularVelocity, i); }
  Quat orientation(std::size_t i) const { return {column(3)[i], column(4)[i], column(5)[i], column(6)[i]}; }
  // The engine's own matrix where it keeps one (it need not be orthonormal), else the quaternion's.
  Mat3 rotation(std::size_t i) const {
    if (!has_rotation_) return matrix_of(orientation(i));
    Mat3 m;
    for (int k = 0; k < 9; ++k) m(k / 3, k % 3) = column(kRotation + k)[i];
    return m;
  }
  BodyState body(std::size_t i) const { return {position(i), orientation(i), velocity(i), angular_velocity(i)}; }

  void set_position(std::size_t i, const Vec3& p) const { set_vector(kPosition, i, p); }
  void set_velocity(std::size_t i, const Vec3& v) const { set_vector(kVelocity, i, v); }
  void set_angular_velocity(std::size_t i, const Vec3& w) const { set_vector(kAngularVelocity, i, w); }
  void set_orientation(std::size_t i, const Quat& q) const {
    column(3)[i] = q.w(), column(4)[i] = q.x(), column(5)[i] = q.y(), column(6)[i] = q.z();
  }
  void set_rotation(std::size_t i, const Mat3& m) const {
    for (int k = 0; k < 9; ++k) column(kRotation + k)[i] = m(k / 3, k % 3);
  }
  void set_body(std::size_t i, const BodyState& s) const {
    set_position(i, s.position), set_orientation(i, s.orientation);
    set_velocity(i, s.velocity), set_angular_velocity(i, s.angular_velocity);
  }

  operator BodyColumnsOf<const Scalar>() const { return {first_, stride_, size_, has_rotation_}; }

 private:
  Vec3 vector(int c, std::size_t i) const { return {column(c)[i], column(c + 1)[i], column(c + 2)[i]}; }
  void set_vector(int c, std::size_t i, const Vec3& v) const {
    column(c)[i] = v.x(), column(c + 1)[i] = v.y(), column(c + 2)[i] = v.z();
  }

  Scalar* first_ = nullptr;
  std::size_t stride_ = 0, size_ = 0;
  bool has_rotation_ = false;
};
using BodyColumns = BodyColumnsOf<const double>;
using MutableBodyColumns = BodyColumnsOf<double>;

// Both of the same size, and both with or without rotation matrices.
void copy_columns(BodyColumns from, MutableBodyColumns to);

// Memory from a pool shared by all threads, which never returns memory. Otherwise the samples kept in each step would
// lie between blocks that an engine allocates and frees in that step. This fragmentation made an engine that is created
// anew in each step take gigabytes.
void* take_from_pool(std::size_t bytes);
void give_to_pool(void* place, std::size_t bytes);

template <typename T>
struct PoolAllocator {
  using value_type = T;
  PoolAllocator() = default;
  template <typename U>
  PoolAllocator(const PoolAllocator<U>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(take_from_pool(count * sizeof(T))); }
  void deallocate(T* place, std::size_t count) { give_to_pool(place, count * sizeof(T)); }
  bool operator==(const PoolAllocator&) const { return true; }
};

// Owns its columns. Padded ones (columns.h) are what kernels work on; without padding, a thirteenth of the memory for
// a single body, are the many that are kept of a run and only looked at.
template <bool kIsPadded>
class BodyTableOf {
 public:
  BodyTableOf() = default;
  explicit BodyTableOf(std::size_t size, bool has_rotation = false) { resize(size, has_rotation); }
  explicit BodyTableOf(BodyColumns source) { *this = source; }
  BodyTableOf(const BodyTableOf<!kIsPadded>& source) { *this = source.columns(); }
  BodyTableOf& operator=(BodyColumns source);  // copies the viewed columns

  void resize(std::size_t size, bool has_rotation = false);
  std::size_t size() const { return size_; }
  bool has_rotation() const { return has_rotation_; }

  BodyColumns columns() const { return {data_.data(), stride_, size_, has_rotation_}; }
  MutableBodyColumns columns() { return {data_.data(), stride_, size_, has_rotation_}; }

 private:
  std::vector<double, std::conditional_t<kIsPadded, CacheLineAllocator<double>, PoolAllocator<double>>> data_;
  std::size_t size_ = 0, stride_ = 0;  // see column_stride()
  bool has_rotation_ = false;
};
extern template class BodyTableOf<true>;
extern template class BodyTableOf<false>;
using BodyTable = BodyTableOf<true>;
using KeptBodies = BodyTableOf<false>;

}  // namespace rigor::inline engine
