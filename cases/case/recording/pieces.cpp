#include "cases/case/recording/pieces.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"

namespace rigor::inline cases {
namespace {

template <typename T>
std::vector<T> part_of(const std::vector<T>& values, std::size_t first, std::size_t last) {
  if (values.empty()) return {};
  return {values.begin() + static_cast<long>(first), values.begin() + static_cast<long>(last + 1)};
}

RecordedBody part_of(const RecordedBody& body, std::size_t first, std::size_t last) {
  RecordedBody part;
  part.body = body.body;
  part.times = part_of(body.times, first, last);
  for (double& time : part.times) time -= body.times[first];
  part.positions = part_of(body.positions, first, last);
  part.velocities = part_of(body.velocities, first, last);
  part.angular_velocities = part_of(body.angular_velocities, first, last);
  part.orientations = part_of(body.orientations, first, last);
  return part;
}

void check_same_instants(const RecordedTrial& trial) {
  for (const RecordedBody& body : trial.bodies) {
    if (body.times != trial.bodies.front().times)
      throw InputError(
          fmt::format("the bodies of trial '{}' were measured at different instants; allowed: pieces of "
                      "trials whose bodies have the same ones",
                      trial.name));
  }
}

void add_pieces(const RecordedTrial& trial, double length, std::vector<RecordedTrial>& pieces) {
  constexpr double kRounding = 1e-6;  // of times written with seven digits
  const std::vector<double>& times = trial.bodies.front().times;
  const double most = length * (1 + kRounding);
  for (std::size_t first = 0; times.back() - times[first] >= length * (1 - kRounding);) {
    std::size_t last = first;
    while (last + 1 < times.size() && times[last + 1] - times[first] <= most) ++last;
    if (last == first) {  // what happened in a longer interval was not measured
      ++first;
      continue;
    }
    RecordedTrial piece;
    piece.name = fmt::format("{} from {:.6g} s", trial.name, times[first]);
    piece.duration = times[last] - times[first];
    for (const RecordedBody& body : trial.bodies) piece.bodies.push_back(part_of(body, first, last));
    pieces.push_back(std::move(piece));
    first = last;
  }
}

}  // namespace

std::vector<RecordedTrial> pieces_of(const std::vector<RecordedTrial>& trials, double length) {
  std::vector<RecordedTrial> pieces;
  double longest = 0;
  for (const RecordedTrial& trial : trials) {
    check_same_instants(trial);
    add_pieces(trial, length, pieces);
    longest = std::max(longest, trial.duration);
  }
  if (pieces.empty())
    throw InputError(
        fmt::format("found {:g} s, and the longest trial lasts {:g} s; allowed: at most so long", length, longest));
  return pieces;
}

}  // namespace rigor::inline cases
