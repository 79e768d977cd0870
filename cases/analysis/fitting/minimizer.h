// Minimises a function in the unit box without derivatives: a Latin hypercube, then the simplex method of Nelder and
// Mead (Computer Journal 7 (1965) 308) from several of its points. A point outside the box stands for its mirror image.
#pragma once

#include <functional>
#include <limits>
#include <vector>

namespace rigor::inline analysis {

using BoxPoint = std::vector<double>;  // each from 0 to 1

// `count` points, one in each of `count` equal layers along every axis (McKay, Beckman, Conover, Technometrics 21
// (1979) 239).
std::vector<BoxPoint> latin_hypercube(std::size_t count, std::size_t axes, unsigned long seed);

struct BoxMinimum {
  BoxPoint at;
  double value = 0;
};

struct SimplexOptions {
  double size = 0.15;                                        // of the first simplex
  double tolerance = 1e-4;                                   // the search ends when the simplex is smaller
  std::size_t most = 120;                                    // evaluations
  double enough = -std::numeric_limits<double>::infinity();  // the search ends at a value this small
};

BoxMinimum nelder_mead(const std::function<double(const BoxPoint&)>& function, const BoxMinimum& start,
                       const SimplexOptions& options);

// The best `most` points, best first, each at least `apart` from better ones along some axis.
std::vector<BoxMinimum> distinct_starts(std::vector<BoxMinimum> points, std::size_t most, double apart);

}  // namespace rigor::inline analysis
