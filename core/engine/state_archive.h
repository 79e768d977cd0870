// The state of a world as bytes. Each class names the members that outlive a step in one function,
//   void archive_state(StateArchive& archive) { archive(a_, b_); }
// which both saves and restores, so that the two never differ.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/math.h"
#include "core/engine/body_table.h"
#include "core/engine/clock.h"

namespace rigor::inline engine {

class StateArchive {
 public:
  // One that saves, and one that restores what another saved. `saved` must outlive it.
  StateArchive() = default;
  explicit StateArchive(std::string_view saved) : saved_(saved), restores_(true) {}

  bool restores() const { return restores_; }
  const std::string& bytes() const { return bytes_; }
  std::string_view left() const { return saved_; }  // not yet restored
  // Throws InputError if what was saved is longer.
  void end() const;

  template <typename... Values>
  void operator()(Values&... values) {
    (value(values), ...);
  }
  // Visits the elements of a container whose size follows from the scene. Throws InputError for another size.
  template <typename Container, typename Visit>
  void each(Container& elements, const Visit& visit) {
    fixed_size(elements.size());
    for (auto& element : elements) visit(element);
  }
  // Gives a container the size that it had when it was saved.
  template <typename Container>
  void resized(Container& elements) {
    elements.resize(size(elements.size()));
  }
  // As many as there were when it was saved.
  template <typename Number>
  void numbers(Number* first, std::size_t count) {
    static_assert(std::is_arithmetic_v<Number>);
    fixed_size(count);
    raw(first, count * sizeof(Number));
  }
  // As an element of `from`, or none. Pointers differ from world to world.
  template <typename T>
  void place_in(const std::vector<T>& from, const T*& pointer) {
    std::int64_t place = pointer ? pointer - from.data() : -1;
    value(place);
    if (restores_) pointer = place < 0 ? nullptr : from.data() + in_range(place, from.size());
  }

 private:
  template <typename T>
  void value(T& it) {
    if constexpr (requires { it.archive_state(*this); }) {
      it.archive_state(*this);
    } else if constexpr (std::is_same_v<T, bool>) {
      flag(it);
    } else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      raw(&it, sizeof it);
    } else {
      compound(it);
    }
  }

  void compound(Clock& clock) {
    static_assert(std::is_trivially_copyable_v<Clock>);
    raw(&clock, sizeof clock);
  }
  void compound(std::string& text) {
    text.resize(size(text.size()));
    raw(text.data(), text.size());
  }
  void compound(std::vector<bool>& flags) {
    flags.resize(size(flags.size()));
    for (std::size_t i = 0; i < flags.size(); ++i) {
      bool one = flags[i];
      flag(one);
      flags[i] = one;
    }
  }
  template <typename T, typename Allocator>
  void compound(std::vector<T, Allocator>& elements) {
    elements.resize(size(elements.size()));
    if constexpr (std::is_arithmetic_v<T>) {
      raw(elements.data(), elements.size() * sizeof(T));
    } else {
      for (T& element : elements) value(element);
    }
  }
  template <typename T, std::size_t N>
  void compound(std::array<T, N>& elements) {
    for (T& element : elements) value(element);
  }
  template <typename A, typename B>
  void compound(std::pair<A, B>& both) {
    value(both.first), value(both.second);
  }
  template <typename T>
  void compound(std::optional<T>& perhaps) {
    bool is_there = perhaps.has_value();
    flag(is_there);
    if (!is_there) return perhaps.reset();
    if (!perhaps) perhaps.emplace();
    value(*perhaps);
  }
  template <typename Derived>
  void compound(Eigen::PlainObjectBase<Derived>& matrix) {
    std::int64_t rows = matrix.rows(), columns = matrix.cols();
    value(rows), value(columns);
    if (restores_) {
      const bool is_dynamic = static_cast<int>(Derived::SizeAtCompileTime) == Eigen::Dynamic;
      if (!is_dynamic && (rows != matrix.rows() || columns != matrix.cols())) refuse_size();
      check_room(rows, columns);
      matrix.resize(rows, columns);
    }
    raw(matrix.data(), static_cast<std::size_t>(matrix.size()) * sizeof(typename Derived::Scalar));
  }
  void compound(Quat& q) { value(q.coeffs()); }
  template <bool kIsPadded>
  void compound(BodyTableOf<kIsPadded>& table) {
    std::uint64_t bodies = table.size();
    bool has_rotation = table.has_rotation();
    value(bodies), flag(has_rotation);
    const std::int64_t columns = has_rotation ? kRotation + 9 : kRotation;
    if (restores_) {
      check_room(static_cast<std::int64_t>(bodies), columns);
      if (bodies != table.size() || has_rotation != table.has_rotation()) table.resize(bodies, has_rotation);
    }
    for (int c = 0; c < columns; ++c) raw(table.columns().column(c), bodies * sizeof(double));
  }

  void raw(void* data, std::size_t bytes);
  void flag(bool& it);
  std::size_t size(std::size_t own);  // of a container, as it is now or as it was saved
  void fixed_size(std::size_t own);
  void check_room(std::int64_t rows, std::int64_t columns) const;  // of doubles
  static std::size_t in_range(std::int64_t place, std::size_t size);
  [[noreturn]] static void refuse_size();

  std::string bytes_;
  std::string_view saved_;  // what is still to be restored
  bool restores_ = false;
};

}  // namespace rigor::inline engine
