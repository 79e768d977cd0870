#include "core/dynamics/contact/impulse/rebounds/impact_search.h"

namespace rigor::inline dynamics {

void ImpactSearch::begin(const ContactRowLayout& rows) {
  for (std::size_t thread = 0; thread < parts_.size(); ++thread) {
    std::size_t most = 0;
    for (std::size_t colour = 0; colour < rows.colours(); ++colour) {
      const auto [begin, end] = rows.share(colour, thread);
      for (std::size_t g = begin; g < end; ++g)
        most += kRowsPerBlock * static_cast<std::size_t>(rows.groups()[g].points);
    }
    if (parts_[thread].found.size() < most) parts_[thread].found.resize(most);
  }
}

void ImpactSearch::find(const ContactRowLayout& rows, const SolverBodies& bodies, const SolverParameters& parameters,
                        std::size_t thread) {
  Part& part = parts_[thread];
  part.end_of_colour.clear();
  std::size_t found = 0;
  for (std::size_t colour = 0; colour < rows.colours(); ++colour) {
    const auto [begin, end] = rows.share(colour, thread);
    found +=
        contact_kernels().prepare_bias(rows.groups().data(), begin, end, bodies, parameters, part.found.data() + found);
    part.end_of_colour.push_back(found);
  }
}

void ImpactSearch::give(const ContactRowLayout& rows, RowSweeps& impacts) const {
  impacts.clear();
  for (std::size_t colour = 0; colour < rows.colours(); ++colour) {
    for (const Part& part : parts_) {
      const std::size_t first = colour == 0 ? 0 : part.end_of_colour[colour - 1];
      impacts.add(part.found.data() + first, part.found.data() + part.end_of_colour[colour]);
    }
  }
  impacts.form_groups();
}

}  // namespace rigor::inline dynamics
