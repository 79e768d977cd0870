#include "cases/report/html/force_playback.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace rigor::inline report {
namespace {

// An engine may name the bodies of a pair in either order.
std::pair<int, int> pair_of(const ReportedContact& contact) { return std::minmax({contact.a, contact.b}); }

// 32768 is zero, so that what does not touch has exactly no normal.
std::uint16_t signed_share(double value) {
  return static_cast<std::uint16_t>(32768 + std::lround(32767 * std::clamp(value, -1.0, 1.0)));
}

}  // namespace

ForcePlayback::ForcePlayback(const Trajectory& trajectory) : trajectory_(trajectory) {
  std::map<std::pair<int, int>, double> impulses;  // of a pair, up to the step's length
  for (const Sample& sample : trajectory.samples) {
    for (const ReportedContact& contact : sample.contacts) impulses[pair_of(contact)] += contact.force.norm();
  }
  for (const auto& [pair, impulse] : impulses) {
    if (impulse > 0) pairs_.push_back(pair);
  }
  std::stable_sort(pairs_.begin(), pairs_.end(),
                   [&](const auto& one, const auto& other) { return impulses.at(one) > impulses.at(other); });
  if (pairs_.size() > kMostPairs) pairs_.resize(kMostPairs);
  for (const auto& pair : pairs_) {
    std::vector<double>& sizes = sizes_.emplace_back();
    for (std::size_t n = 0; n < trajectory.samples.size(); ++n) sizes.push_back(resultant(n, pair).force.norm());
  }
}

ForcePlayback::Resultant ForcePlayback::resultant(std::size_t sample, std::pair<int, int> pair) const {
  Resultant sum;
  double pressing = 0;
  for (const ReportedContact& contact : trajectory_.samples[sample].contacts) {
    if (pair_of(contact) != pair) continue;
    const double sign = contact.a == pair.first ? 1 : -1;
    const double normal_force = std::max(0.0, contact.force.dot(contact.normal));
    sum.force += sign * contact.force;
    sum.point += normal_force * contact.point, sum.normal += sign * normal_force * contact.normal;
    pressing += normal_force;
  }
  if (pressing > 0) sum.point /= pressing, sum.normal.normalize();
  return sum;
}

void ForcePlayback::add_to(Bytes& bytes, const std::vector<std::size_t>& samples) const {
  bytes.add_u32(static_cast<std::uint32_t>(pairs_.size()));
  for (const auto& [a, b] : pairs_)
    bytes.add_u32(static_cast<std::uint32_t>(a)), bytes.add_u32(static_cast<std::uint32_t>(b));
  if (pairs_.empty()) return;
  std::vector<Resultant> all;
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& pair : pairs_) {
    for (const std::size_t n : samples) {
      const Resultant& one = all.emplace_back(resultant(n, pair));
      if (one.normal != Vec3::Zero()) low = low.cwiseMin(one.point), high = high.cwiseMax(one.point);
    }
  }
  if (!(low.x() <= high.x())) low = high = Vec3::Zero();
  const Vec3 extent = high - low;
  for (const Vec3& corner : {low, extent}) {
    for (const double value : corner) bytes.add_f32(static_cast<float>(value));
  }
  const auto value_of = [&](const Resultant& one, int channel) {
    const int axis = channel % 3;
    if (channel < 3) return quantised(extent[axis] > 0 ? (one.point[axis] - low[axis]) / extent[axis] : 0);
    return channel < 6 ? half_of_float(one.force[axis]) : signed_share(one.normal[axis]);
  };
  std::vector<std::uint16_t> values;
  for (std::size_t pair = 0; pair < pairs_.size(); ++pair) {
    for (int channel = 0; channel < 9; ++channel) {
      for (std::size_t n = 0; n < samples.size(); ++n)
        values.push_back(value_of(all[pair * samples.size() + n], channel));
    }
  }
  bytes.add_differences(values);
}

}  // namespace rigor::inline report
