// Sweeps over some of the rows, until none changes a velocity by more than the tolerance: those of impacts, whose
// points must agree, and those of deep overlaps. Impacts that share no body, nor others in between, do not know of each
// other, so that threads share these clusters.
#pragma once

#include <vector>

#include "core/base/thread_pool.h"
#include "core/dynamics/contact/impulse/contact_row_layout.h"
#include "core/dynamics/kernels/contact_kernels.h"

namespace rigor {

class RowSweeps {
 public:
  explicit RowSweeps(ThreadPool& threads) : threads_(threads), parts_(threads.members()) {}

  // Before the rows' first sub-step.
  void begin(const ContactRowLayout& rows);
  // A thread's share of the biases of a sub-step, and which of its rows are impacts.
  void find(const ContactRowLayout& rows, const SolverBodies& bodies, const SolverParameters& parameters,
            std::size_t thread);
  // Deals the impacts that were found out to the threads.
  void deal_out(const ContactRowLayout& rows);
  bool are_any() const;
  // A thread's share of the sweeps over the impacts.
  void solve(const ContactRowLayout& rows, const SolverBodies& bodies, const SolverParameters& parameters,
             std::size_t thread);
  // Sweeps without bias over the rows that overlap deeply, which are few: by one thread.
  void relax_deep(const ContactRowLayout& rows, const SolverBodies& bodies, const SolverParameters& parameters,
                  std::size_t thread);

 private:
  struct alignas(kCacheLine) Part {
    std::vector<RowPlace> found;             // in the order of groups; room for all
    std::vector<std::size_t> end_of_colour;  // among these
    std::vector<RowPlace> impacts;           // that this thread sweeps, in their order
    std::int64_t sweeps = 0;                 // so far
    std::size_t first_of(std::size_t colour) const { return colour == 0 ? 0 : end_of_colour[colour - 1]; }
  };
  template <typename Visit>
  void for_each_found(const ContactRowLayout& rows, const Visit& visit) const;
  std::int32_t cluster_of(std::int32_t body);

  ThreadPool& threads_;
  std::vector<Part> parts_;              // by thread
  std::vector<std::int32_t> next_;       // by record: another of its cluster, nearer to the one that stands for it
  std::vector<std::int32_t> thread_of_;  // by cluster; -1: none yet
};

}  // namespace rigor
