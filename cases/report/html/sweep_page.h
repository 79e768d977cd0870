// sweep.html: the results of a sweep as a map for two keys, lines for one, points for more. It is one file without
// dependencies and without a script.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "cases/analysis/sweep/sweep.h"

namespace rigor::inline report {

// px, of the area between the axes
namespace sweep_drawing {
inline constexpr double kLeft = 88, kTop = 14, kWidth = 300, kHeight = 210;
}  // namespace sweep_drawing

class SweepPage {
 public:
  explicit SweepPage(const Sweep& sweep);
  void add(const SweepRow& row);  // in their order
  std::string text() const;

 private:
  static constexpr std::size_t kErrors = 3;
  // A key, its values as far as they are known beforehand.
  struct Key {
    std::string name;
    std::vector<std::string> values;  // of a grid
    bool is_log = false;
    double from = 0, to = 0;
  };
  // What is kept of a row.
  struct Point {
    std::size_t of_case, run;
    std::vector<float> at;  // of each key: the number of its value in a grid, or the value itself
    unsigned char kind;     // a row of the table of kinds
    std::array<float, kErrors> errors;
    std::array<bool, kErrors> is_held_to_itself;  // of errors: stands in brackets
    float omega_dt;                               // of the scene's stiffest spring; 0: it has none
  };
  using Points = std::vector<const Point*>;
  struct Range {
    double least, most;
    double share(double value) const;  // in logarithms
  };

  bool is_grid() const { return !sweep_.is_sampled(); }
  bool has_key_of_steps() const;
  double share_of(std::size_t key, const Point& point) const;
  Points points_of(std::size_t of_case, std::size_t run) const;
  std::size_t error_shown(std::size_t of_case) const;  // index of error_names_
  Range range_of(std::size_t of_case, std::size_t error) const;
  std::string legend(std::size_t of_case) const;
  std::string section(std::size_t of_case) const;
  std::string map(const Points& points, std::size_t error, const Range* range) const;
  std::string lines(std::size_t of_case, std::size_t error, const Range& range) const;
  std::string scatter(const Points& points, std::size_t key, std::size_t error, const Range& range) const;
  std::string scatter_of_two(const Points& points) const;
  std::string frame(std::size_t x_key, const std::string& y_label) const;
  std::string ticks(std::size_t key, bool is_x) const;
  std::string error_ticks(const Range& range) const;
  std::string hint(const Point& point, std::size_t error) const;
  // The line ω dt = 2, see sweep_limit.cpp.
  double stiffest_frequency_of(const SweepRow& row);
  std::string limit_in_map(const Points& points, std::size_t x, std::size_t y) const;
  std::string limit_in_lines(std::size_t of_case) const;
  std::string limit_key(std::size_t of_case) const;

  const Sweep& sweep_;
  std::vector<Key> keys_;
  std::vector<std::string> error_names_;
  std::vector<Point> points_;
  std::vector<std::string> last_scene_;  // case and values that the frequency below belongs to
  double last_frequency_ = 0;            // rad/s
};

}  // namespace rigor::inline report
