#include "core/dynamics/collision/broad_phase.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace rigor {
namespace {

constexpr double kFarthestCell = 1 << 18;  // nineteen bits an axis, and five for the grid
constexpr double kWider = 1 + 1e-6;        // than the box: more than roundings of a cell's number

// Without branches, which nobody could predict. Unordered numbers compare false: a box that is none overlaps all, and
// the narrow phase sees it.
bool overlap(const Aabb& a, const Aabb& b) {
  bool are_apart = false;
  for (int axis = 0; axis < 3; ++axis) are_apart |= (a.low[axis] > b.high[axis]) | (b.low[axis] > a.high[axis]);
  return !are_apart;
}

using CellIndex = std::array<std::int64_t, 3>;

CellIndex cell_of(const Vec3& p, double width) {
  CellIndex cell;
  for (int axis = 0; axis < 3; ++axis)
    cell[axis] =
        static_cast<std::int64_t>(std::clamp(std::floor(p[axis] / width), -kFarthestCell + 1, kFarthestCell - 1));
  return cell;
}

std::uint64_t number_of(int grid, std::int64_t x, std::int64_t y, std::int64_t z) {
  constexpr std::int64_t kOffset = 1 << 18;
  return static_cast<std::uint64_t>(grid) << 57 | static_cast<std::uint64_t>(x + kOffset) << 38 |
         static_cast<std::uint64_t>(y + kOffset) << 19 | static_cast<std::uint64_t>(z + kOffset);
}

}  // namespace

// The finest cells hold three quarters of the boxes, by a sample of them. Whatever they are, the same pairs are found.
void BroadPhase::choose_width(const std::vector<Aabb>& boxes) {
  constexpr std::size_t kSample = 64;
  sizes_.clear();
  for (std::size_t i = 0; i < boxes.size(); i += 1 + boxes.size() / kSample) {
    const double size = (boxes[i].high - boxes[i].low).maxCoeff();
    if (std::isfinite(size) && size > 0) sizes_.push_back(size);
  }
  double width = 1;
  if (!sizes_.empty()) {
    const auto most = sizes_.begin() + static_cast<std::ptrdiff_t>(3 * sizes_.size() / 4);
    std::nth_element(sizes_.begin(), most, sizes_.end());
    width = 1.01 * *most;
  }
  for (double& of_grid : widths_) of_grid = width, width *= 2;
}

// Written so that what is not a number is unbounded.
int BroadPhase::grid_of(const Aabb& box) const {
  const double size = kWider * (box.high - box.low).maxCoeff();
  const double farthest = std::max(box.low.cwiseAbs().maxCoeff(), box.high.cwiseAbs().maxCoeff());
  for (int grid = 0; grid < kGrids; ++grid) {
    if (size <= widths_[grid]) return farthest < (kFarthestCell - 2) * widths_[grid] ? grid : -1;
  }
  return -1;
}

std::size_t BroadPhase::bucket_of(std::uint64_t cell) const { return (cell * 0x9E3779B97F4A7C15u) >> (64 - bits_); }

void BroadPhase::enter(const std::vector<Aabb>& boxes) {
  bits_ = std::bit_width(2 * boxes.size() + 1);
  first_entry_.assign((std::size_t{1} << bits_) + 1, 0);
  grid_.resize(boxes.size()), cells_.resize(boxes.size());
  boxes_of_grid_.fill(0);
  unbounded_.clear();
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    grid_[i] = grid_of(boxes[i]);
    if (grid_[i] < 0) {
      unbounded_.push_back(static_cast<int>(i));
      continue;
    }
    const auto [x, y, z] = cell_of(boxes[i].low, widths_[grid_[i]]);
    cells_[i] = number_of(grid_[i], x, y, z);
    ++boxes_of_grid_[grid_[i]];
    ++first_entry_[bucket_of(cells_[i])];
  }
  std::exclusive_scan(first_entry_.begin(), first_entry_.end(), first_entry_.begin(), std::size_t{0});
  entries_.resize(boxes.size() - unbounded_.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (grid_[i] >= 0) entries_[first_entry_[bucket_of(cells_[i])]++] = {cells_[i], static_cast<int>(i)};
  }
  std::shift_right(first_entry_.begin(), first_entry_.end(), 1);
  first_entry_.front() = 0;
}

// Those with a changed box: each of these with all that are not, and with the changed ones that come after it.
void BroadPhase::try_pair(int place, int other, const std::vector<Aabb>& boxes, Pairs& found) const {
  if (is_changed_[other] != 0 && other <= place) return;
  if (overlap(boxes[place], boxes[other])) found.push_back(std::minmax(place, other));
}

void BroadPhase::search_all(int place, const std::vector<Aabb>& boxes, Pairs& found) const {
  for (int other = 0; other < static_cast<int>(boxes.size()); ++other) try_pair(place, other, boxes, found);
}

void BroadPhase::search_grid(int grid, int place, const std::vector<Aabb>& boxes, Pairs& found) const {
  CellIndex low = cell_of(boxes[place].low, widths_[grid]);
  const CellIndex high = cell_of(boxes[place].high, widths_[grid]);
  double cells = 1;
  for (int axis = 0; axis < 3; ++axis) cells *= static_cast<double>(high[axis] - --low[axis] + 1);
  if (cells > static_cast<double>(boxes.size())) {
    for (const Entry& entry : entries_) {
      if (grid_[entry.box] == grid) try_pair(place, entry.box, boxes, found);
    }
    return;
  }
  for (std::int64_t x = low[0]; x <= high[0]; ++x)
    for (std::int64_t y = low[1]; y <= high[1]; ++y)
      for (std::int64_t z = low[2]; z <= high[2]; ++z) {
        const std::uint64_t cell = number_of(grid, x, y, z);
        const std::size_t bucket = bucket_of(cell);
        for (std::size_t k = first_entry_[bucket]; k < first_entry_[bucket + 1]; ++k) {
          if (entries_[k].cell == cell) try_pair(place, entries_[k].box, boxes, found);
        }
      }
}

void BroadPhase::search_grids(int place, const std::vector<Aabb>& boxes, Pairs& found) const {
  if (grid_[place] < 0) return;
  for (int grid = 0; grid < kGrids; ++grid) {
    if (boxes_of_grid_[grid] > 0) search_grid(grid, place, boxes, found);
  }
}

void BroadPhase::pairs_with_unbounded(const std::vector<Aabb>& boxes, Pairs& found) const {
  for (const int i : unbounded_) {
    for (int j = 0; j < static_cast<int>(boxes.size()); ++j) {
      if (is_changed_[i] == 0 && is_changed_[j] == 0) continue;
      // Of two unbounded ones, the first tells the pair.
      if (j == i || (j < i && grid_[j] < 0)) continue;
      if (overlap(boxes[i], boxes[j])) found.emplace_back(std::min(i, j), std::max(i, j));
    }
  }
}

// The new ones by the first of both, and then the few of each by the second; and with them those that still hold.
void BroadPhase::sort_pairs() {
  first_pair_.assign(is_changed_.size() + 2, 0);
  for (const Pairs& found : found_)
    for (const auto& pair : found) ++first_pair_[static_cast<std::size_t>(pair.first) + 2];
  std::partial_sum(first_pair_.begin(), first_pair_.end(), first_pair_.begin());
  sorted_.resize(first_pair_.back());
  for (const Pairs& found : found_)
    for (const auto& pair : found) sorted_[first_pair_[static_cast<std::size_t>(pair.first) + 1]++] = pair;
  const auto at = [&](std::size_t place) { return sorted_.begin() + static_cast<std::ptrdiff_t>(first_pair_[place]); };
  for (std::size_t place = 0; place < is_changed_.size(); ++place) {
    if (first_pair_[place + 1] - first_pair_[place] > 1) std::sort(at(place), at(place + 1));
  }
  kept_.swap(pairs_);
  pairs_.resize(kept_.size() + sorted_.size());
  std::merge(kept_.begin(), kept_.end(), sorted_.begin(), sorted_.end(), pairs_.begin());
}

const std::vector<std::pair<int, int>>& BroadPhase::overlaps(const std::vector<Aabb>& boxes) {
  pairs_.clear();
  all_.resize(boxes.size());
  std::iota(all_.begin(), all_.end(), 0);
  return overlaps(boxes, all_);
}

const std::vector<std::pair<int, int>>& BroadPhase::overlaps(const std::vector<Aabb>& boxes,
                                                             const std::vector<int>& changed, ThreadPool* threads) {
  is_changed_.assign(boxes.size(), 0);
  for (const int place : changed) is_changed_[place] = 1;
  std::erase_if(pairs_, [&](const auto& pair) { return (is_changed_[pair.first] | is_changed_[pair.second]) != 0; });
  // To enter a box in its cell takes as long as to try twenty pairs, to look through the cells as two hundred.
  const std::size_t all = boxes.size(), some = changed.size();
  const bool has_grids = some * all > 20 * all + 200 * some;
  if (has_grids) choose_width(boxes), enter(boxes);
  found_.resize(threads ? threads->members() : 1);
  const auto search = [&](std::size_t thread) {
    Pairs& found = found_[thread];
    found.clear();
    const auto [first, last] = threads ? threads->share(some, thread) : ThreadPool::Share{0, some};
    for (std::size_t i = first; i < last; ++i)
      has_grids ? search_grids(changed[i], boxes, found) : search_all(changed[i], boxes, found);
  };
  threads ? threads->run(search) : search(0);
  if (has_grids) pairs_with_unbounded(boxes, found_.front());
  sort_pairs();
  return pairs_;
}

}  // namespace rigor
