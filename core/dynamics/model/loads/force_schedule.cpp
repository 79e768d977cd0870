#include "core/dynamics/model/loads/force_schedule.h"

#include <algorithm>
#include <limits>

namespace rigor::inline dynamics {

ForceSchedule::ForceSchedule(const std::vector<TimedForce>& forces) : latest_end_(forces.size()) {
  for (std::size_t i = 0; i < forces.size(); ++i) {
    entries_.push_back({forces[i].from, forces[i].until, i});
    switches_.insert(switches_.end(), {forces[i].from, forces[i].until});
  }
  std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.from < b.from; });
  std::sort(switches_.begin(), switches_.end());
  switches_.erase(std::unique(switches_.begin(), switches_.end()), switches_.end());
  latest_end_of(0, entries_.size());
}

double ForceSchedule::latest_end_of(std::size_t first, std::size_t last) {
  if (first == last) return -std::numeric_limits<double>::infinity();
  const std::size_t middle = first + (last - first) / 2;
  return latest_end_[middle] =
             std::max({latest_end_of(first, middle), entries_[middle].until, latest_end_of(middle + 1, last)});
}

// Those of the entries [first, last) that begin at `to` or before and end at `from` or later.
void ForceSchedule::collect(std::size_t first, std::size_t last, double from, double to,
                            std::vector<std::size_t>& out) const {
  if (first == last) return;
  const std::size_t middle = first + (last - first) / 2;
  if (latest_end_[middle] < from) return;
  collect(first, middle, from, to, out);
  if (entries_[middle].from > to) return;
  if (entries_[middle].until >= from) out.push_back(entries_[middle].index);
  collect(middle + 1, last, from, to, out);
}

std::vector<std::size_t> ForceSchedule::acting(double one, double other) const {
  std::vector<std::size_t> indices;
  collect(0, entries_.size(), std::min(one, other), std::max(one, other), indices);
  std::sort(indices.begin(), indices.end());
  return indices;
}

double ForceSchedule::next_switch(double t, double end) const {
  if (t < end) {
    const auto next = std::upper_bound(switches_.begin(), switches_.end(), t);
    return next != switches_.end() && *next < end ? *next : end;
  }
  const auto next = std::lower_bound(switches_.begin(), switches_.end(), t);
  return next != switches_.begin() && *(next - 1) > end ? *(next - 1) : end;
}

}  // namespace rigor::inline dynamics
