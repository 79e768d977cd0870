// The series of one run and the sizes of its contact forces, all at the same samples: thinned together and packed.
#pragma once

#include <vector>

#include "cases/report/html/force_playback.h"
#include "cases/report/html/thinning.h"
#include "cases/results/results.h"

namespace rigor::inline report {

// A u32 for their number, then two lists as Bytes::add_differences: the lower and the upper halves.
void add_samples(Bytes& bytes, const std::vector<std::size_t>& samples);

class SeriesSet {
 public:
  // `forces` must live on.
  SeriesSet(std::vector<NamedSeries> all, const ForcePlayback& forces);

  std::size_t count() const { return count_; }
  KeptSample worst_between(std::size_t a, std::size_t b) const;
  void add_to(Bytes& bytes, const std::vector<std::size_t>& points) const;

 private:
  // A series on the two scales of a plot, in units of the smallest visible difference.
  struct Seen {
    std::vector<double> linear, decades;
  };
  void look_at(const std::vector<double>& values);

  std::vector<NamedSeries> series_;
  const ForcePlayback* forces_;
  std::vector<Seen> seen_;
  std::size_t count_ = 0;
};

}  // namespace rigor::inline report
