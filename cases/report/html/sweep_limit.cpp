// The line ω dt = 2 in the drawings of a sweep. ω is the frequency of the scene's stiffest spring. Semi-implicit Euler
// blows up beyond the line if the spring is not damped.
#include <cmath>
#include <map>
#include <utility>

#include "cases/analysis/small_motions/stiffest_frequency.h"
#include "cases/report/html/svg.h"
#include "cases/report/html/sweep_page.h"

namespace rigor::inline report {
namespace {

constexpr float kLimit = 2;

// A light line below a dark one, so that it is seen on every colour.
std::string limit_line(double x1, double y1, double x2, double y2) {
  return svg_line(x1, y1, x2, y2, "limit-halo") + svg_line(x1, y1, x2, y2, "limit");
}

}  // namespace

// Rows come variant by variant, so the last scene is often the one that is asked for.
double SweepPage::stiffest_frequency_of(const SweepRow& row) {
  std::vector<std::string> scene = {std::to_string(row.of_case)};
  for (std::size_t i = 0; i < row.values.size(); ++i)
    if (sweep_.axes()[i].kind == SweepAxis::Kind::scene) scene.push_back(row.values[i]);
  if (scene != last_scene_)
    last_frequency_ = stiffest_frequency(sweep_.definition_of(row).scene), last_scene_ = std::move(scene);
  return last_frequency_;
}

// Along the edges between cells on either side.
std::string SweepPage::limit_in_map(const Points& points, std::size_t x, std::size_t y) const {
  std::map<std::pair<int, int>, float> field;
  for (const Point* point : points)
    field[{static_cast<int>(point->at[x]), static_cast<int>(point->at[y])}] = point->omega_dt;
  const double width = sweep_drawing::kWidth / static_cast<double>(keys_[x].values.size()),
               height = sweep_drawing::kHeight / static_cast<double>(keys_[y].values.size());
  std::string text;
  for (const auto& [at, value] : field) {
    const double right = sweep_drawing::kLeft + (at.first + 1) * width,
                 bottom = sweep_drawing::kTop + sweep_drawing::kHeight - at.second * height, top = bottom - height;
    const auto is_crossed = [&](std::pair<int, int> neighbour) {
      const auto found = field.find(neighbour);
      return found != field.end() && (value < kLimit) != (found->second < kLimit);
    };
    if (is_crossed({at.first + 1, at.second})) text += limit_line(right, top, right, bottom);
    if (is_crossed({at.first, at.second + 1})) text += limit_line(right - width, top, right, top);
  }
  return text;
}

std::string SweepPage::limit_in_lines(std::size_t of_case) const {
  const Points points = points_of(of_case, 0);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double a = points[i - 1]->omega_dt, b = points[i]->omega_dt;
    if (!(a > 0 && b > 0) || (a < kLimit) == (b < kLimit)) continue;
    const double from = share_of(0, *points[i - 1]), to = share_of(0, *points[i]);
    const double x =
        sweep_drawing::kLeft + sweep_drawing::kWidth * (from + (to - from) * std::log(kLimit / a) / std::log(b / a));
    return limit_line(x, sweep_drawing::kTop, x, sweep_drawing::kTop + sweep_drawing::kHeight);
  }
  return "";
}

// Nothing where the line is not drawn.
std::string SweepPage::limit_key(std::size_t of_case) const {
  if (!is_grid() || keys_.empty() || keys_.size() > 2) return "";
  bool is_below = false, is_above = false;
  for (const Point& point : points_) {
    if (point.of_case != of_case || !(point.omega_dt > 0)) continue;
    (point.omega_dt < kLimit ? is_below : is_above) = true;
  }
  if (!is_below || !is_above) return "";
  return "<p><span class=\"key\"><i class=\"limit-sample\"></i>ω dt = 2 of the stiffest spring: beyond it, "
         "semi-implicit Euler blows up unless the spring is damped</span></p>\n<p class=\"faint\">Near the line the "
         "energy of a bounded run oscillates. A tenfold rise counts as blown up. Single cells may differ from their "
         "neighbours, because the verdict reads the energy in the last tenth of the run.</p>\n";
}

}  // namespace rigor::inline report
