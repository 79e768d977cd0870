#include "core/dynamics/contact/pair_finder.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

void PairFinder::enter_boxes(const std::vector<Aabb>& boxes) {
  sizes_.clear();
  for (const Aabb& box : boxes) {
    const double size = (box.high - box.low).maxCoeff();
    if (std::isfinite(size) && size > 0) sizes_.push_back(size);
  }
  width_ = 1;
  if (!sizes_.empty()) {
    const auto middle = sizes_.begin() + static_cast<std::ptrdiff_t>(sizes_.size() / 2);
    std::nth_element(sizes_.begin(), middle, sizes_.end());
    width_ = 2 * *middle;
  }
  entries_.clear();
  large_.clear();
  for (int i = 0; i < static_cast<int>(boxes.size()); ++i) {
    const Aabb& box = boxes[i];
    const double farthest = std::max(box.low.cwiseAbs().maxCoeff(), box.high.cwiseAbs().maxCoeff());
    // Written so that what is not a number is large.
    if (!((box.high - box.low).maxCoeff() <= kLarge * width_ && farthest < kFarthestCell * width_)) {
      large_.push_back(i);
      continue;
    }
    const auto cell = [&](const Vec3& p, int axis) { return cell_index(p[axis], width_); };
    for (std::int64_t x = cell(box.low, 0); x <= cell(box.high, 0); ++x)
      for (std::int64_t y = cell(box.low, 1); y <= cell(box.high, 1); ++y)
        for (std::int64_t z = cell(box.low, 2); z <= cell(box.high, 2); ++z)
          entries_.push_back({cell_number(x, y, z), box.low.x(), i});
  }
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.low != b.low ? a.low < b.low : a.box < b.box;
  });
}

void PairFinder::pairs_of_cell(const std::vector<Aabb>& boxes, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    const Aabb& a = boxes[entries_[i].box];
    for (std::size_t j = i + 1; j < last && entries_[j].low <= a.high.x(); ++j) {
      const Aabb& b = boxes[entries_[j].box];
      if (!overlap(a, b)) continue;
      const Vec3 corner = a.low.cwiseMax(b.low);
      const std::uint64_t cell =
          cell_number(cell_index(corner.x(), width_), cell_index(corner.y(), width_), cell_index(corner.z(), width_));
      if (cell == entries_[first].cell) pairs_.push_back(std::minmax(entries_[i].box, entries_[j].box));
    }
  }
}

const std::vector<std::pair<int, int>>& PairFinder::overlaps(const std::vector<Aabb>& boxes) {
  enter_boxes(boxes);
  pairs_.clear();
  for (std::size_t first = 0; first < entries_.size();) {
    std::size_t last = first + 1;
    while (last < entries_.size() && entries_[last].cell == entries_[first].cell) ++last;
    pairs_of_cell(boxes, first, last);
    first = last;
  }
  for (std::size_t k = 0; k < large_.size(); ++k) {
    const int i = large_[k];
    for (int j = 0; j < static_cast<int>(boxes.size()); ++j) {
      // Of two large boxes, the first tells the pair.
      if (j == i || (j < i && std::binary_search(large_.begin(), large_.end(), j))) continue;
      // Unordered numbers compare false: such a box is told with all, and the narrow phase sees it.
      const bool apart =
          (boxes[i].low.array() > boxes[j].high.array()).any() || (boxes[j].low.array() > boxes[i].high.array()).any();
      if (!apart) pairs_.emplace_back(std::min(i, j), std::max(i, j));
    }
  }
  std::sort(pairs_.begin(), pairs_.end());
  return pairs_;
}

}  // namespace rigor
