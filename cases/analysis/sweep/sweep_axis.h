// What is varied in a sweep: KEY=VALUES, a key and the values that it takes.
#pragma once

#include <string>
#include <vector>

namespace rigor {

struct SweepAxis {
  // step: dt. length: the run's duration. option: of a method. scene: a value of the scene, by its path.
  enum class Kind { step, length, option, scene };
  std::string key;
  Kind kind = Kind::option;
  std::vector<std::string> values;  // as they are put to use and shown: "1/30", "0.3", "quickstep"
  // Of a range, which samples may be drawn from between its values.
  bool is_range = false, is_log = false;
  double from = 0, to = 0;
  bool is_whole = false;  // of an option that takes whole numbers alone
};

inline constexpr long kMostValues = 1000000;  // of one key

// VALUES is a list, 10,20,50, of numbers, fractions or words; or a range, FROM..TO:COUNT, evenly from one to the other,
// or FROM..TO:log:COUNT, evenly in their logarithms. Where samples are drawn from it, a range needs no count. Throws
// InputError for what is neither, a range the wrong way round, a value given twice.
SweepAxis parse_axis(const std::string& text, bool is_sampled);

// The value at a share of the axis from 0 to 1: of a list, one of its values.
std::string value_at(const SweepAxis& axis, double share);

// Rounds the values of a range; those that are then the same are one.
void make_whole(SweepAxis& axis);

// A number, or a fraction of two; not a number for any other text.
double number_in(const std::string& text);

// "N/m", by the last name in a path of the scene; "" where it is not known.
std::string unit_of_axis(const SweepAxis& axis);

// The points of a sample, each a share from 0 to 1 of every axis: Sobol's sequence, each coordinate moved around by an
// offset that the seed draws (Cranley, Patterson, SIAM J. Numer. Anal. 13 (1976) 904).
std::vector<std::vector<double>> sample_points(std::size_t count, std::size_t axes, unsigned long seed);

}  // namespace rigor
