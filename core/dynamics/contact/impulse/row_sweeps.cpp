#include "core/dynamics/contact/impulse/row_sweeps.h"

#include <algorithm>
#include <numeric>

namespace rigor {

void RowSweeps::begin(const ContactRowLayout& rows) {
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

void RowSweeps::find(const ContactRowLayout& rows, const SolverBodies& bodies, const SolverParameters& parameters,
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

// In the order of groups.
template <typename Visit>
void RowSweeps::for_each_found(const ContactRowLayout& rows, const Visit& visit) const {
  for (std::size_t colour = 0; colour < rows.colours(); ++colour) {
    for (const Part& part : parts_) {
      for (std::size_t i = part.first_of(colour); i < part.end_of_colour[colour]; ++i)
        visit(part.found[i], rows.groups()[static_cast<std::size_t>(part.found[i].group)]);
    }
  }
}

std::int32_t RowSweeps::cluster_of(std::int32_t body) {
  while (next_[body] != body) body = next_[body] = next_[next_[body]];
  return body;
}

// Each cluster to the thread with the fewest rows so far. Fixed bodies, which are written nowhere, join nothing.
void RowSweeps::deal_out(const ContactRowLayout& rows) {
  for (Part& part : parts_) part.impacts.clear();
  if (parts_.size() == 1) {
    for_each_found(rows, [&](const RowPlace& place, const RowGroup&) { parts_.front().impacts.push_back(place); });
    return;
  }
  next_.resize(rows.records());
  thread_of_.assign(rows.records(), -1);
  std::iota(next_.begin(), next_.end(), 0);
  const auto moves = [](std::int32_t body, std::int32_t to) { return body == to; };
  for_each_found(rows, [&](const RowPlace& place, const RowGroup& group) {
    const std::int32_t a = group.a[place.lane], b = group.b[place.lane];
    if (moves(a, group.to_a[place.lane]) && moves(b, group.to_b[place.lane])) next_[cluster_of(a)] = cluster_of(b);
  });
  for_each_found(rows, [&](const RowPlace& place, const RowGroup& group) {
    const std::int32_t a = group.a[place.lane], b = group.b[place.lane];
    std::int32_t& thread = thread_of_[cluster_of(moves(a, group.to_a[place.lane]) ? a : b)];
    if (thread < 0) {
      const auto fewest = std::min_element(parts_.begin(), parts_.end(), [](const Part& x, const Part& y) {
        return x.impacts.size() < y.impacts.size();
      });
      thread = static_cast<std::int32_t>(fewest - parts_.begin());
    }
    parts_[static_cast<std::size_t>(thread)].impacts.push_back(place);
  });
}

bool RowSweeps::are_any() const {
  return std::any_of(parts_.begin(), parts_.end(), [](const Part& part) { return !part.impacts.empty(); });
}

void RowSweeps::solve(const ContactRowLayout& rows, const SolverBodies& bodies, const SolverParameters& parameters,
                      std::size_t thread) {
  Part& part = parts_[thread];
  for (int k = 0; k < parameters.max_sweeps && !part.impacts.empty(); ++k) {
    const Sweep now{part.sweeps + k, k == 0};
    if (!contact_kernels().sweep_with_bias(rows.groups().data(), part.impacts.data(), part.impacts.size(), bodies,
                                           parameters, now))
      break;
  }
  part.sweeps += parameters.max_sweeps + 1;  // what these sweeps have changed is not new to the next ones
  threads_.meet();
}

void RowSweeps::relax_deep(const ContactRowLayout& rows, const SolverBodies& bodies, const SolverParameters& parameters,
                           std::size_t thread) {
  const std::vector<RowPlace>& deep = rows.deep_rows();
  if (deep.empty()) return;
  Part& part = parts_[thread];
  for (int k = 0; thread == 0 && k < parameters.max_sweeps; ++k) {
    const Sweep now{part.sweeps + k, k == 0};
    if (!contact_kernels().sweep_without_bias(rows.groups().data(), deep.data(), deep.size(), bodies, parameters, now))
      break;
  }
  part.sweeps += parameters.max_sweeps + 1;
  threads_.meet();
}

}  // namespace rigor
