#include "core/dynamics/collision/broad_phase.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rigor {
namespace {

constexpr double kFarthestCell = 1 << 20;  // twenty-one bits an axis
constexpr double kLarge = 4;               // cells along one axis

bool overlap(const Aabb& a, const Aabb& b) {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

std::uint64_t cell_number(std::int64_t x, std::int64_t y, std::int64_t z) {
  constexpr std::int64_t kOffset = 1 << 20;
  return static_cast<std::uint64_t>(x + kOffset) << 42 | static_cast<std::uint64_t>(y + kOffset) << 21 |
         static_cast<std::uint64_t>(z + kOffset);
}

std::int64_t cell_index(double coordinate, double width) {
  return static_cast<std::int64_t>(std::floor(coordinate / width));
}

// Of what is sorted up to `known`.
template <class T>
void sort_from(std::vector<T>& values, std::ptrdiff_t known) {
  std::sort(values.begin() + known, values.end());
  std::inplace_merge(values.begin(), values.begin() + known, values.end());
}

}  // namespace

void BroadPhase::choose_width(const std::vector<Aabb>& boxes) {
  sizes_.clear();
  for (const Aabb& box : boxes) {
    const double size = (box.high - box.low).maxCoeff();
    if (std::isfinite(size) && size > 0) sizes_.push_back(size);
  }
  width_ = 1;
  if (sizes_.empty()) return;
  const auto middle = sizes_.begin() + static_cast<std::ptrdiff_t>(sizes_.size() / 2);
  std::nth_element(sizes_.begin(), middle, sizes_.end());
  width_ = 2 * *middle;
}

void BroadPhase::forget_changed() {
  const auto is_changed = [&](int place) { return is_changed_[place] != 0; };
  std::erase_if(entries_, [&](const Entry& entry) { return is_changed(entry.box); });
  std::erase_if(large_, is_changed);
  std::erase_if(pairs_, [&](const auto& pair) { return is_changed(pair.first) || is_changed(pair.second); });
}

void BroadPhase::enter(const Aabb& box, int place) {
  const double farthest = std::max(box.low.cwiseAbs().maxCoeff(), box.high.cwiseAbs().maxCoeff());
  // Written so that what is not a number is large.
  if (!((box.high - box.low).maxCoeff() <= kLarge * width_ && farthest < kFarthestCell * width_)) {
    large_.push_back(place);
    return;
  }
  const auto cell = [&](const Vec3& p, int axis) { return cell_index(p[axis], width_); };
  for (std::int64_t x = cell(box.low, 0); x <= cell(box.high, 0); ++x)
    for (std::int64_t y = cell(box.low, 1); y <= cell(box.high, 1); ++y)
      for (std::int64_t z = cell(box.low, 2); z <= cell(box.high, 2); ++z)
        entries_.push_back({cell_number(x, y, z), box.low.x(), place});
}

// Those with a changed box: each of these with all that are not, and with the changed ones that come after it.
void BroadPhase::pairs_of_cell(const std::vector<Aabb>& boxes, std::size_t first, std::size_t last) {
  const auto try_pair = [&](int a, int b) {
    if (!overlap(boxes[a], boxes[b])) return;
    const Vec3 corner = boxes[a].low.cwiseMax(boxes[b].low);
    const std::uint64_t cell =
        cell_number(cell_index(corner.x(), width_), cell_index(corner.y(), width_), cell_index(corner.z(), width_));
    if (cell == entries_[first].cell) pairs_.push_back(std::minmax(a, b));
  };
  for (std::size_t i = first; i < last; ++i) {
    const int place = entries_[i].box;
    if (is_changed_[place] == 0) continue;
    for (std::size_t j = first; j < i; ++j) {
      if (is_changed_[entries_[j].box] == 0) try_pair(place, entries_[j].box);
    }
    const double high = boxes[place].high.x();
    for (std::size_t j = i + 1; j < last && entries_[j].low <= high; ++j) try_pair(place, entries_[j].box);
  }
}

void BroadPhase::pairs_with_large(const std::vector<Aabb>& boxes) {
  for (const int i : large_) {
    for (int j = 0; j < static_cast<int>(boxes.size()); ++j) {
      if (is_changed_[i] == 0 && is_changed_[j] == 0) continue;
      // Of two large boxes, the first tells the pair.
      if (j == i || (j < i && std::binary_search(large_.begin(), large_.end(), j))) continue;
      // Unordered numbers compare false: such a box is told with all, and the narrow phase sees it.
      const bool apart =
          (boxes[i].low.array() > boxes[j].high.array()).any() || (boxes[j].low.array() > boxes[i].high.array()).any();
      if (!apart) pairs_.emplace_back(std::min(i, j), std::max(i, j));
    }
  }
}

const std::vector<std::pair<int, int>>& BroadPhase::overlaps(const std::vector<Aabb>& boxes) {
  choose_width(boxes);
  entries_.clear(), large_.clear(), pairs_.clear();
  all_.resize(boxes.size());
  std::iota(all_.begin(), all_.end(), 0);
  return overlaps(boxes, all_);
}

const std::vector<std::pair<int, int>>& BroadPhase::overlaps(const std::vector<Aabb>& boxes,
                                                             const std::vector<int>& changed) {
  is_changed_.assign(boxes.size(), 0);
  for (const int place : changed) is_changed_[place] = 1;
  forget_changed();
  const auto known_entries = static_cast<std::ptrdiff_t>(entries_.size()),
             known_pairs = static_cast<std::ptrdiff_t>(pairs_.size());
  for (const int place : changed) enter(boxes[place], place);
  std::sort(large_.begin(), large_.end());
  sort_from(entries_, known_entries);
  for (std::size_t first = 0; first < entries_.size();) {
    bool any_changed = false;
    std::size_t last = first;
    for (; last < entries_.size() && entries_[last].cell == entries_[first].cell; ++last)
      any_changed = any_changed || is_changed_[entries_[last].box] != 0;
    if (any_changed) pairs_of_cell(boxes, first, last);
    first = last;
  }
  pairs_with_large(boxes);
  sort_from(pairs_, known_pairs);
  return pairs_;
}

}  // namespace rigor
