#include "core/dynamics/collision/broad_phase.h"

#include <algorithm>
#include <numeric>

namespace rigor::inline dynamics {

// Finds the pairs of changed boxes: each changed box with all unchanged ones, and with the changed ones that follow it.
void BroadPhase::search(int place, const std::vector<Aabb>& boxes, Part& part) const {
  for (const int other : tree_.overlapping(boxes[static_cast<std::size_t>(place)], part.scratch)) {
    if (is_changed_[static_cast<std::size_t>(other)] != 0 && other <= place) continue;
    part.found.emplace_back(std::min(place, other), std::max(place, other));
  }
}

// Sorts by the first of both, and then the few of each by the second.
void BroadPhase::sort_found() {
  first_pair_.assign(is_changed_.size() + 2, 0);
  for (const Part& part : parts_)
    for (const auto& pair : part.found) ++first_pair_[static_cast<std::size_t>(pair.first) + 2];
  std::partial_sum(first_pair_.begin(), first_pair_.end(), first_pair_.begin());
  found_.resize(first_pair_.back());
  for (const Part& part : parts_)
    for (const auto& pair : part.found) found_[first_pair_[static_cast<std::size_t>(pair.first) + 1]++] = pair;
  const auto at = [&](std::size_t place) { return found_.begin() + static_cast<std::ptrdiff_t>(first_pair_[place]); };
  for (std::size_t place = 0; place < is_changed_.size(); ++place) {
    if (first_pair_[place + 1] - first_pair_[place] > 1) std::sort(at(place), at(place + 1));
  }
}

// With those that still hold.
void BroadPhase::merge() {
  kept_.swap(pairs_);
  pairs_.resize(kept_.size() + found_.size());
  auto next = found_.begin();
  auto out = pairs_.begin();
  for (const auto& pair : kept_) {
    for (; next != found_.end() && *next < pair; ++next) *out++ = *next;
    *out = pair;
    out +=
        (is_changed_[static_cast<std::size_t>(pair.first)] | is_changed_[static_cast<std::size_t>(pair.second)]) == 0;
  }
  pairs_.erase(std::copy(next, found_.end(), out), pairs_.end());
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
  for (const int place : changed) is_changed_[static_cast<std::size_t>(place)] = 1;
  tree_.update(boxes, changed);
  parts_.resize(threads ? threads->members() : 1);
  const auto search_share = [&](std::size_t thread) {
    Part& part = parts_[thread];
    part.found.clear();
    const auto [first, last] = threads ? threads->share(changed.size(), thread) : ThreadPool::Share{0, changed.size()};
    for (std::size_t i = first; i < last; ++i) search(changed[i], boxes, part);
  };
  threads ? threads->run(search_share) : search_share(0);
  sort_found();
  merge();
  return pairs_;
}

}  // namespace rigor::inline dynamics
