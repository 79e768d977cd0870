// An axis of a sweep, KEY=VALUES: a key and its values.
#pragma once

#include <string>
#include <vector>

namespace rigor::inline analysis {

struct SweepAxis {
  // step: dt. length: the run's duration. option: of a method. scene: a value of the scene, by its path.
  enum class Kind { step, length, option, scene };
  std::string key;
  Kind kind = Kind::option;
  std::vector<std::string> values;  // as used and shown: "1/30", "0.3", "quickstep"
  // Of a range. Samples are drawn between its ends.
  bool is_range = false, is_log = false;
  double from = 0, to = 0;
  bool is_whole = false;  // of an option that takes only whole numbers
};

inline constexpr long kMostValues = 1000000;  // of one key

// VALUES is a list of numbers, fractions or words, as 10,20,50. Or it is a range: FROM..TO:COUNT is evenly spaced, and
// FROM..TO:log:COUNT evenly in logarithms. A range needs no count if samples are drawn. Throws InputError for any other
// text, for a range in the wrong order and for a repeated value.
SweepAxis parse_axis(const std::string& text, bool is_sampled);

// The value at a share from 0 to 1 of the axis; for a list, one of its values.
std::string value_at(const SweepAxis& axis, double share);

// Rounds the values of a range and removes duplicates.
void make_whole(SweepAxis& axis);

// A number or a fraction of two numbers; NaN for any other text.
double number_in(const std::string& text);

// "N/m", from the last name in a path of the scene; "" if it is not known.
std::string unit_of_axis(const SweepAxis& axis);

// The points of a sample, each with a share from 0 to 1 of every axis. They are Sobol's sequence, shifted modulo 1 by
// an offset drawn from the seed (Cranley, Patterson, SIAM J. Numer. Anal. 13 (1976) 904).
std::vector<std::vector<double>> sample_points(std::size_t count, std::size_t axes, unsigned long seed);

}  // namespace rigor::inline analysis
