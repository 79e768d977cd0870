// Finds which of many timed forces act in a step, and the next instant at which one begins or ends, without a search
// through all. It is a static interval tree over the forces in the order of their starts (Cormen, Leiserson, Rivest,
// Stein, Introduction to Algorithms, section 14.3). It keeps no state between queries. A query costs log n plus the
// size of its result.
#pragma once

#include <cstddef>
#include <vector>

#include "core/scene/scene.h"

namespace rigor::inline dynamics {

class ForceSchedule {
 public:
  explicit ForceSchedule(const std::vector<TimedForce>& forces);

  // The indices, ascending, of every force that acts at some instant between two times [s], given in any order. Forces
  // that only begin or end there may be included.
  std::vector<std::size_t> acting(double one, double other) const;
  // The first instant strictly between t and `end` at which a force begins or ends; `end` if there is none. `end` may
  // be before t.
  double next_switch(double t, double end) const;

 private:
  struct Entry {
    double from, until;
    std::size_t index;
  };
  double latest_end_of(std::size_t first, std::size_t last);
  void collect(std::size_t first, std::size_t last, double from, double to, std::vector<std::size_t>& out) const;

  std::vector<Entry> entries_;      // by the instant at which they begin
  std::vector<double> latest_end_;  // of the range of entries of which this one is the middle
  std::vector<double> switches_;    // s, ascending, each once
};

}  // namespace rigor::inline dynamics
