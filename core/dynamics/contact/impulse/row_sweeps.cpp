#include "core/dynamics/contact/impulse/row_sweeps.h"

#include <algorithm>

namespace rigor::inline dynamics {

void RowSweeps::clear() {
  groups_.clear(), sources_.clear();
  last_group_ = -1;
}

void RowSweeps::add(const RowPlace* first, const RowPlace* last) {
  for (const RowPlace* place = first; place != last; ++place) {
    if (place->group != last_group_) slot_of_lane_.fill(-1);
    last_group_ = place->group;
    std::int64_t& slot = slot_of_lane_[static_cast<std::size_t>(place->lane)];
    if (slot < 0) slot = static_cast<std::int64_t>(slot_for(*place));
    const auto at = static_cast<std::size_t>(slot);
    sources_[at / kRowsPerBlock].points[at % kRowsPerBlock] |= 1u << place->point;
  }
}

// For another pair: the next one of the last group, or the first of a new one.
std::size_t RowSweeps::slot_for(const RowPlace& place) {
  const RowGroup& from = rows_.groups()[static_cast<std::size_t>(place.group)];
  if (groups_.empty() || sources_.back().pairs == kRowsPerBlock || groups_.back().colour != from.colour ||
      groups_.back().points != from.points || groups_.back().of_balls != from.of_balls)
    groups_.push_back(from), sources_.push_back({});
  Source& source = sources_.back();
  source.group[source.pairs] = place.group, source.lane[source.pairs] = place.lane;
  return kRowsPerBlock * (groups_.size() - 1) + source.pairs++;
}

void RowSweeps::form_groups() { place_rows(groups_, copies_); }

void RowSweeps::copy_rows(std::size_t number) {
  RowGroup& group = groups_[number];
  const Source& source = sources_[number];
  const auto idle = static_cast<std::int32_t>(rows_.idle_body()), to_none = idle + 1;
  if (source.pairs < kRowsPerBlock || group.points > 1) clear_rows(group);
  std::fill_n(group.a, kRowsPerBlock, idle), std::fill_n(group.b, kRowsPerBlock, idle);
  std::fill_n(group.to_a, kRowsPerBlock, to_none), std::fill_n(group.to_b, kRowsPerBlock, to_none);
  for (std::size_t k = 0; k < source.pairs; ++k) {
    const RowGroup& from = rows_.groups()[static_cast<std::size_t>(source.group[k])];
    const auto lane = static_cast<std::size_t>(source.lane[k]);
    group.a[k] = from.a[lane], group.b[k] = from.b[lane];
    if (from.to_a[lane] == from.a[lane]) group.to_a[k] = from.a[lane];
    if (from.to_b[lane] == from.b[lane]) group.to_b[k] = from.b[lane];
    for (std::size_t point = 0; point < static_cast<std::size_t>(group.points); ++point) {
      if ((source.points[k] >> point & 1) == 0) continue;
      const double* row = from.block(point) + lane;
      double* copy = group.block(point) + k;
      for (std::size_t c = 0; c < group.columns(); ++c) copy[c * kRowsPerBlock] = row[c * kRowsPerBlock];
    }
  }
}

// What a sweep changes of a row: the impulse along the normal and, in the columns after it, those across.
void RowSweeps::copy_impulses_back(std::size_t number) const {
  const Source& source = sources_[number];
  for (std::size_t k = 0; k < source.pairs; ++k) {
    const RowGroup& from = rows_.groups()[static_cast<std::size_t>(source.group[k])];
    for (std::size_t point = 0; point < static_cast<std::size_t>(from.points); ++point) {
      if ((source.points[k] >> point & 1) == 0) continue;
      double* row = from.block(point) + source.lane[k];
      const double* copy = groups_[number].block(point) + k;
      for (std::size_t c = kImpulse; c < kFrictionImpulse + 3; ++c) row[c * kRowsPerBlock] = copy[c * kRowsPerBlock];
    }
  }
}

void RowSweeps::solve(Sweep sweep, const SolverBodies& bodies, const SolverParameters& parameters, std::size_t thread) {
  if (groups_.empty()) return;
  if (thread == 0) {
    for (std::size_t g = 0; g < groups_.size(); ++g) copy_rows(g);
    int sweeps = 0;
    while (sweeps++ < parameters.max_sweeps && sweep(groups_.data(), groups_.size(), bodies, parameters)) continue;
    for (std::size_t g = 0; g < groups_.size(); ++g) copy_impulses_back(g);
  }
  threads_.meet();
}

}  // namespace rigor::inline dynamics
