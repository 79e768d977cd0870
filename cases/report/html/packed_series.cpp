#include "cases/report/html/packed_series.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cases/report/html/playback.h"

namespace rigor::inline report {
namespace {

constexpr double kLinearSeen = 5e-3;   // of a series' range: a pixel of a plot
constexpr double kDecadesSeen = 0.04;  // of a logarithmic plot: likewise
constexpr double kNoise = 1e-12;       // of a series in any unit: smaller values are rounding without shape

void raise_to_deviations(const std::vector<double>& values, std::size_t a, std::size_t b,
                         const std::vector<double>& shares, std::vector<double>& off) {
  const double first = values[a], last = values[b];
  const double* between = &values[a] + 1;
  for (std::size_t k = 0; k < off.size(); ++k)
    off[k] = std::max(off[k], std::abs(between[k] - (1 - shares[k]) * first - shares[k] * last));
}

}  // namespace

const std::vector<std::string>& series_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = {kEnergyChange};
    for (const MetricRow& row : metrics()) all.push_back(row.name);
    return all;
  }();
  return names;
}

void add_samples(Bytes& bytes, const std::vector<std::size_t>& samples) {
  std::vector<std::uint16_t> low, high;
  for (const std::size_t n : samples) {
    low.push_back(static_cast<std::uint16_t>(n)), high.push_back(static_cast<std::uint16_t>(n >> 16));
  }
  bytes.add_u32(static_cast<std::uint32_t>(samples.size()));
  bytes.add_differences(low), bytes.add_differences(high);
}

SeriesSet::SeriesSet(std::vector<NamedSeries> all, const ForcePlayback& forces)
    : series_(std::move(all)), forces_(&forces) {
  for (const NamedSeries& series : series_) look_at(series.values);
  for (const std::vector<double>& sizes : forces.sizes()) look_at(sizes);
}

void SeriesSet::look_at(const std::vector<double>& values) {
  double largest = kNoise;
  for (const double value : values) {
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  }
  const double floor = std::max(kNoise, 1e-6 * largest);
  Seen& seen = seen_.emplace_back();
  for (const double value : values) {
    seen.linear.push_back(value / (largest * kLinearSeen));
    seen.decades.push_back(std::log10(std::max(std::abs(value), floor)) / kDecadesSeen);
  }
  count_ = std::max(count_, values.size());
}

// Series by series, because each is contiguous.
KeptSample SeriesSet::worst_between(std::size_t a, std::size_t b) const {
  std::vector<double> shares(b - a - 1), off(b - a - 1, 0.0);  // of the samples from a + 1 on
  for (std::size_t k = 0; k < shares.size(); ++k) shares[k] = static_cast<double>(k + 1) / static_cast<double>(b - a);
  for (const Seen& seen : seen_) {
    const std::size_t length = seen.linear.size();
    if (b < length) {
      raise_to_deviations(seen.linear, a, b, shares, off), raise_to_deviations(seen.decades, a, b, shares, off);
    } else if (length >= a + 2) {  // it ends in this stretch, and its end is kept
      off[length - a - 2] = std::numeric_limits<double>::max();
    }
  }
  KeptSample worst{a, 0};
  for (std::size_t k = 0; k < off.size(); ++k) {
    if (off[k] > worst.deviation) worst = {a + 1 + k, off[k]};
  }
  return worst;
}

void SeriesSet::add_to(Bytes& bytes, const std::vector<std::size_t>& points) const {
  add_samples(bytes, points);
  bytes.add_u8(static_cast<std::uint8_t>(series_.size()));
  for (const NamedSeries& series : series_) {
    const auto& names = series_names();
    bytes.add_u8(static_cast<std::uint8_t>(std::find(names.begin(), names.end(), series.name) - names.begin()));
  }
  std::vector<std::uint16_t> values;
  for (const NamedSeries& series : series_) {
    for (const std::size_t n : points)
      values.push_back(half_of_float(n < series.values.size() ? series.values[n] : NAN));
  }
  bytes.add_differences(values);
  forces_->add_to(bytes, points);
}

}  // namespace rigor::inline report
