// The contact law of each pair of bodies, found in constant time.
#pragma once

#include <cstdint>
#include <unordered_map>

#include "core/scene/scene.h"

namespace rigor::inline scene {

class ContactLaws {
 public:
  explicit ContactLaws(const Scene& scene);

  const ContactLaw& of(int a, int b) const {  // the order of a and b does not matter
    if (laws_.empty()) return default_;
    const auto found = laws_.find(key(a, b));
    return found == laws_.end() ? default_ : found->second;
  }

  // False for a pair that the scene keeps apart. Does not look at shapes.
  bool may_touch(int a, int b) const { return !some_are_apart_ || of(a, b).collides; }
  bool some_are_apart() const { return some_are_apart_; }

 private:
  static std::uint64_t key(int a, int b) {
    const auto low = static_cast<std::uint32_t>(a < b ? a : b), high = static_cast<std::uint32_t>(a < b ? b : a);
    return (std::uint64_t{high} << 32) | low;
  }

  ContactLaw default_;
  std::unordered_map<std::uint64_t, ContactLaw> laws_;
  bool some_are_apart_ = false;
};

// Whether both bodies collide and at least one of them moves. Does not look at the law of the pair.
bool can_meet(const Body& a, const Body& b);

// Whether any two bodies of the scene can touch. If not, an adapter need not look for contacts.
bool anything_can_touch(const Scene& scene);

}  // namespace rigor::inline scene
