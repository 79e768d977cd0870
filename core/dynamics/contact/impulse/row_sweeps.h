// Sweeps over some of the rows, until none changes a velocity by more than the tolerance: those of impacts, whose
// points must agree, and those of deep overlaps.
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
  bool are_any() const;
  // A thread's share of sweeps over the impacts; `sweep` is the kernel.
  void solve(decltype(ContactKernels::sweep_with_bias) sweep, const ContactRowLayout& rows, const SolverBodies& bodies,
             const SolverParameters& parameters, std::size_t thread);
  // Sweeps without bias over the rows that overlap deeply, which are few: by one thread.
  void relax_deep(const ContactRowLayout& rows, const SolverBodies& bodies, const SolverParameters& parameters,
                  std::size_t thread);

 private:
  struct alignas(kCacheLine) Part {
    std::vector<SomeRows> impacts;          // in the order of groups; room for all
    std::vector<std::size_t> end_of_level;  // among these
    std::int64_t sweeps = 0;                // so far; the same for all threads
    bool is_changed[2] = {false, false};    // by the sweep of an even number, and of an odd one
    std::size_t first_of(std::size_t level) const { return level == 0 ? 0 : end_of_level[level - 1]; }
  };
  bool has_impacts(std::size_t level) const;

  ThreadPool& threads_;
  std::vector<Part> parts_;  // by thread
};

}  // namespace rigor
