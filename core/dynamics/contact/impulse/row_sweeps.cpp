#include "core/dynamics/contact/impulse/row_sweeps.h"

#include <algorithm>

namespace rigor {

void RowSweeps::begin(const ContactRowLayout& rows) {
  for (std::size_t thread = 0; thread < parts_.size(); ++thread) {
    Part& part = parts_[thread];
    std::size_t blocks = 0;
    for (std::size_t level = 0; level < rows.levels(); ++level) {
      const auto [begin, end] = rows.share(level, thread);
      for (std::size_t g = begin; g < end; ++g) blocks += static_cast<std::size_t>(rows.groups()[g].points);
    }
    if (part.impacts.size() < blocks) part.impacts.resize(blocks);
  }
}

void RowSweeps::find(const ContactRowLayout& rows, const SolverBodies& bodies, const SolverParameters& parameters,
                     std::size_t thread) {
  Part& part = parts_[thread];
  part.end_of_level.clear();
  std::size_t found = 0;
  for (std::size_t level = 0; level < rows.levels(); ++level) {
    const auto [begin, end] = rows.share(level, thread);
    found += contact_kernels().prepare_bias(rows.groups().data(), begin, end, bodies, parameters,
                                            part.impacts.data() + found);
    part.end_of_level.push_back(found);
  }
}

bool RowSweeps::has_impacts(std::size_t level) const {
  return std::any_of(parts_.begin(), parts_.end(),
                     [&](const Part& part) { return part.end_of_level[level] > part.first_of(level); });
}

bool RowSweeps::are_any() const {
  return std::any_of(parts_.begin(), parts_.end(),
                     [](const Part& part) { return !part.end_of_level.empty() && part.end_of_level.back() > 0; });
}

// No thread comes to write the flag that others read before it has met them once more.
void RowSweeps::solve(decltype(ContactKernels::sweep_with_bias) sweep, const ContactRowLayout& rows,
                      const SolverBodies& bodies, const SolverParameters& parameters, std::size_t thread) {
  if (!are_any()) return;
  Part& part = parts_[thread];
  bool is_changed = true;
  for (int k = 0; k < parameters.max_sweeps && is_changed; ++k) {
    const Sweep now{++part.sweeps, k == 0};
    bool& is_changed_here = part.is_changed[now.number % 2];
    is_changed_here = false;
    for (std::size_t level = 0; level < rows.levels(); ++level) {
      if (!has_impacts(level)) continue;
      const std::size_t first = part.first_of(level), last = part.end_of_level[level];
      is_changed_here |=
          sweep(rows.groups().data(), part.impacts.data() + first, last - first, bodies, parameters, now);
      threads_.meet();
    }
    is_changed =
        std::any_of(parts_.begin(), parts_.end(), [&](const Part& other) { return other.is_changed[now.number % 2]; });
  }
  part.sweeps += 2;  // what the last sweeps have changed is not new to the next ones
}

void RowSweeps::relax_deep(const ContactRowLayout& rows, const SolverBodies& bodies, const SolverParameters& parameters,
                           std::size_t thread) {
  const std::vector<SomeRows>& deep = rows.deep_rows();
  if (deep.empty()) return;
  Part& part = parts_[thread];
  for (int k = 0; thread == 0 && k < parameters.max_sweeps; ++k) {
    const Sweep now{part.sweeps + 1 + k, k == 0};
    if (!contact_kernels().sweep_without_bias(rows.groups().data(), deep.data(), deep.size(), bodies, parameters, now))
      break;
  }
  part.sweeps += parameters.max_sweeps + 2;
  threads_.meet();
}

}  // namespace rigor
