#include "core/dynamics/collision/box_tree.h"

#include <algorithm>
#include <numeric>

namespace rigor::inline dynamics {
namespace {

constexpr int kBitsOfAxis = 10;

// Its bits with two zeros after each.
std::uint32_t spread(std::uint32_t x) {
  x = (x | x << 16) & 0x030000FF;
  x = (x | x << 8) & 0x0300F00F;
  x = (x | x << 4) & 0x030C30C3;
  return (x | x << 2) & 0x09249249;
}

}  // namespace

void BoxTree::update(const std::vector<Aabb>& boxes, const std::vector<int>& changed) {
  changes_ += changed.size();
  if (boxes.size() != slots_.size() || changes_ > boxes.size()) sort(boxes);
  for (const int place : changed)
    enter(boxes[static_cast<std::size_t>(place)], slots_[static_cast<std::size_t>(place)]);
  fit();
}

// Boxes without a centre come last.
void BoxTree::sort(const std::vector<Aabb>& boxes) {
  const auto middle = [&](std::size_t i) -> Vec3 { return 0.5 * (boxes[i].low + boxes[i].high); };
  Vec3 low = Vec3::Constant(kInfinity), high = -low;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (middle(i).allFinite()) low = low.cwiseMin(middle(i)), high = high.cwiseMax(middle(i));
  }
  const double cells = (1 << kBitsOfAxis) - 1, scale = cells / std::max((high - low).maxCoeff(), 1e-300);
  keys_.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Vec3 at = scale * (middle(i) - low);
    std::uint64_t key = ~std::uint32_t{0};
    if (at.allFinite()) {
      key = 0;
      for (int axis = 0; axis < 3; ++axis)
        key |= spread(static_cast<std::uint32_t>(std::clamp(at[axis], 0.0, cells))) << axis;
    }
    keys_[i] = key << 32 | i;
  }
  std::sort(keys_.begin(), keys_.end());
  changes_ = 0;
  order_.resize(boxes.size()), slots_.resize(boxes.size());
  levels_.resize(1);
  constexpr auto none = [](std::size_t count) {
    Node empty;
    std::fill_n(&empty.low[0][0], 3 * kChildren, kInfinity);
    std::fill_n(&empty.high[0][0], 3 * kChildren, -kInfinity);
    return std::vector<Node>((count + kChildren - 1) / kChildren, empty);
  };
  levels_[0] = none(boxes.size());
  while (levels_.back().size() > 1) levels_.push_back(none(levels_.back().size()));
  numbers_.resize(levels_[0].size());
  std::iota(numbers_.begin(), numbers_.end(), 0);
  for (std::size_t slot = 0; slot < boxes.size(); ++slot) {
    const std::size_t place = keys_[slot] & ~std::uint32_t{0};
    order_[slot] = static_cast<int>(place), slots_[place] = slot;
    enter(boxes[place], slot);
  }
}

// Written so that NaN counts as unbounded.
void BoxTree::enter(const Aabb& box, std::size_t slot) {
  Node& node = levels_[0][slot / kChildren];
  for (int axis = 0; axis < 3; ++axis) {
    node.low[axis][slot % kChildren] = box.low[axis] >= -kInfinity ? box.low[axis] : -kInfinity;
    node.high[axis][slot % kChildren] = box.high[axis] <= kInfinity ? box.high[axis] : kInfinity;
  }
}

void BoxTree::fit() {
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    const std::vector<Node>& below = levels_[level - 1];
    for (std::size_t i = 0; i < below.size(); ++i) {
      Node& parent = levels_[level][i / kChildren];
      for (int axis = 0; axis < 3; ++axis) {
        parent.low[axis][i % kChildren] = *std::min_element(below[i].low[axis], below[i].low[axis] + kChildren);
        parent.high[axis][i % kChildren] = *std::max_element(below[i].high[axis], below[i].high[axis] + kChildren);
      }
    }
  }
}

// Without branches, which nobody could predict.
int* BoxTree::append_overlapping(const Node& node, const Aabb& box, Places children, int* out) {
  std::int64_t is_apart[kChildren] = {};
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < kChildren; ++k)
      is_apart[k] |= int(node.low[axis][k] > box.high[axis]) | int(box.low[axis] > node.high[axis][k]);
  }
  const std::int64_t* is_next_apart = is_apart;
  for (const int child : children) {
    *out = child;
    out += *is_next_apart++ == 0;
  }
  return out;
}

BoxTree::Places BoxTree::overlapping(const Aabb& box, Scratch& scratch) const {
  if (order_.empty()) return {nullptr, nullptr};
  scratch.nodes.assign(1, 0);
  int *first = scratch.nodes.data(), *last = first + 1;
  for (std::size_t level = levels_.size(); level-- > 0;) {
    const std::vector<int>& numbers = level == 0 ? order_ : numbers_;
    const std::size_t count = level == 0 ? order_.size() : levels_[level - 1].size();
    const auto most = kChildren * static_cast<std::size_t>(last - first);
    if (scratch.children.size() < most) scratch.children.resize(2 * most);
    int* out = scratch.children.data();
    for (const int* node = first; node != last; ++node) {
      const std::size_t at = kChildren * static_cast<std::size_t>(*node), end = std::min(at + kChildren, count);
      const Places children = {numbers.data() + at, numbers.data() + end};
      out = append_overlapping(levels_[level][at / kChildren], box, children, out);
    }
    scratch.nodes.swap(scratch.children);
    first = scratch.nodes.data(), last = out;
  }
  return {first, last};
}

}  // namespace rigor::inline dynamics
