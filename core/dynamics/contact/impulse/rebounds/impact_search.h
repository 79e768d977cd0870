// Finds the rows that meet in a sub-step, faster than gravity alone would bring them together.
#pragma once

#include <vector>

#include "core/dynamics/contact/impulse/row_sweeps.h"

namespace rigor::inline dynamics {

class ImpactSearch {
 public:
  explicit ImpactSearch(std::size_t threads) : parts_(threads) {}

  // Before the rows' first sub-step.
  void begin(const ContactRowLayout& rows);
  // A thread's share of the biases of a sub-step, and which of its rows are impacts.
  void find(const ContactRowLayout& rows, const SolverBodies& bodies, const SolverParameters& parameters,
            std::size_t thread);
  // All that were found, in the order of the groups.
  void give(const ContactRowLayout& rows, RowSweeps& impacts) const;

 private:
  struct alignas(kCacheLine) Part {
    std::vector<RowPlace> found;             // in the order of groups; room for all
    std::vector<std::size_t> end_of_colour;  // among these
  };
  std::vector<Part> parts_;  // by thread
};

}  // namespace rigor::inline dynamics
