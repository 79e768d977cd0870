// Sweeps over some of the rows, until none changes a velocity by more than the tolerance: rows of impacts, whose points
// must agree, and rows of deep overlaps. These rows are copied to separate groups, again eight pairs of a colour in
// each, and their impulses are copied back after convergence.
#pragma once

#include <array>
#include <vector>

#include "core/base/thread_pool.h"
#include "core/dynamics/contact/impulse/contact_row_layout.h"
#include "core/dynamics/kernels/contact_kernels.h"

namespace rigor::inline dynamics {

class RowSweeps {
 public:
  using Sweep = decltype(ContactKernels::sweep_with_bias);

  RowSweeps(const ContactRowLayout& rows, ThreadPool& threads) : rows_(rows), threads_(threads) {}

  // Clears the selection; then adds rows, in the order of the groups.
  void clear();
  void add(const RowPlace* first, const RowPlace* last);
  // After these, by one thread.
  void form_groups();
  bool are_any() const { return !groups_.empty(); }
  // Only the first thread sweeps; the others wait. The rows are few, and threads would have to synchronise after each
  // colour.
  void solve(Sweep sweep, const SolverBodies& bodies, const SolverParameters& parameters, std::size_t thread);

 private:
  struct Source {  // the pairs of a group
    std::int32_t group[kRowsPerBlock], lane[kRowsPerBlock];
    unsigned points[kRowsPerBlock];  // one bit each: whether the point's row is selected
    std::size_t pairs;
  };
  std::size_t slot_for(const RowPlace& place);
  void copy_rows(std::size_t number);
  void copy_impulses_back(std::size_t number) const;

  const ContactRowLayout& rows_;
  ThreadPool& threads_;
  std::vector<RowGroup> groups_;
  std::vector<Source> sources_;                           // by group
  std::int32_t last_group_ = -1;                          // of the rows, that one was taken of
  std::array<std::int64_t, kRowsPerBlock> slot_of_lane_;  // of its pairs; -1: not taken
  AlignedDoubles copies_;
};

}  // namespace rigor::inline dynamics
