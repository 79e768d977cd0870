#include "core/scene/joints/axis_series.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace rigor::inline scene {

// Up to three directions, and the rows of their pseudo-inverse.
struct SeriesDirections {
  std::array<Vec3, 3> of, inverse;
  int count = 0;

  void add(const Vec3& direction) { of[static_cast<std::size_t>(count++)] = direction; }
  void invert() {
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> columns(3, count);
    for (int i = 0; i < count; ++i) columns.col(i) = of[static_cast<std::size_t>(i)];
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> gram = columns.transpose() * columns;
    const Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3, 3> inverses = gram.inverse() * columns.transpose();
    for (int i = 0; i < count; ++i) inverse[static_cast<std::size_t>(i)] = inverses.row(i);
  }
};

namespace {

// How far `from` turns about the unit axis to lie as `to` does.
double angle_about(const Vec3& axis, const Vec3& from, const Vec3& to) {
  return portable::atan2(axis.dot(from.cross(to)), from.dot(to) - axis.dot(from) * axis.dot(to));
}

Mat3 turned_about(const Vec3& axis, double angle) { return matrix_of(rotation_by(angle * axis)); }

// The sine of a rotation about its axis, as a vector.
Vec3 sines_of(const Mat3& turn) {
  return 0.5 * Vec3(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
}

std::array<Vec3, 2> two_across(const Vec3& axis) {
  const Vec3 first = axis.unitOrthogonal();
  return {first, axis.cross(first)};
}

// Those across all of the directions; `first`: the two across a single one.
int across_all(const SeriesDirections& directions, const std::array<Vec3, 2>& first, std::array<Vec3, 3>& out) {
  if (directions.count == 0) {
    for (int k = 0; k < 3; ++k) out[static_cast<std::size_t>(k)] = Vec3::Unit(k);
    return 3;
  }
  if (directions.count == 1) {
    out[0] = first[0], out[1] = first[1];
    return 2;
  }
  if (directions.count == 2) {
    out[0] = directions.of[0].cross(directions.of[1]).normalized();
    return 1;
  }
  return 0;
}

}  // namespace

AxisSeries::AxisSeries(const std::vector<SeriesAxis>& axes, const BodyPose& a, const BodyPose& b) : axes_(axes) {
  const Quat to_a = a.orientation.conjugate();
  bool has_slider = false;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    SeriesAxis& axis = axes_[i];
    axis.axis = to_a * axis.axis, axis.anchor = to_a * (axis.anchor - a.position);
    if (axis.turns && hinges_.empty()) across_hinge_ = two_across(axis.axis);
    if (axis.turns) hinges_.push_back(i);
    if (!axis.turns && !has_slider) across_slider_ = two_across(axis.axis), has_slider = true;
  }
  centre_b_ = to_a * (b.position - a.position);
  turn_start_ = matrix_of(to_a * b.orientation);
}

void AxisSeries::find_angles(const Mat3& turn, std::array<double, kMostSeriesAxes>& x, double& sine) const {
  const auto axis = [&](std::size_t n) -> const Vec3& { return axes_[hinges_[n]].axis; };
  if (hinges_.size() == 1) {
    // As a mean over all directions across the axis (core/dynamics/model/hinge_angle.h).
    x[hinges_[0]] = portable::atan2(2 * axis(0).dot(sines_of(turn)), turn.trace() - axis(0).dot(turn * axis(0)));
  } else if (hinges_.size() == 2) {
    x[hinges_[0]] = angle_about(axis(0), axis(1), turn * axis(1));
    x[hinges_[1]] = -angle_about(axis(1), axis(0), turn.transpose() * axis(0));
  } else if (hinges_.size() == 3) {
    const Vec3 &u = axis(0), &v = axis(1), &w = axis(2);
    const double constant = u.dot(v) * v.dot(w), cosine = u.dot(w) - constant, of_sine = u.dot(v.cross(w));
    const double size = std::hypot(cosine, of_sine), phase = portable::atan2(of_sine, cosine);
    const double c = std::clamp((u.dot(turn * w) - constant) / size, -1.0, 1.0);
    const double from_phase = portable::atan2(std::sqrt((1 - c) * (1 + c)), c);
    const double middle = phase - std::copysign(from_phase, phase);
    sine = portable::sin(from_phase);
    const Mat3 by_middle = turned_about(v, middle);
    x[hinges_[0]] = angle_about(u, by_middle * w, turn * w);
    x[hinges_[1]] = middle;
    x[hinges_[2]] = -angle_about(w, by_middle.transpose() * u, turn.transpose() * u);
  }
}

// The axes at a pose, in W, with their hinges turned and their sliders moved.
struct AxisSeries::Chain {
  struct Place {
    Vec3 direction, anchor;
  };
  std::array<double, kMostSeriesAxes> x{};
  std::array<Place, kMostSeriesAxes> places;
  SeriesDirections hinges, sliders;
  std::array<Vec3, 2> across_hinge,
      across_slider;          // the two across the first of a kind
  std::array<Vec3, 3> lever;  // h x r of each hinge
  Vec3 gap;                   // m: of b's centre, beside what the sliders can take
  Mat3 R_b;                   // as the hinges turn it

  // That of a force on b's centre, with the torques that keep the hinges out of
  // it.
  Row along(const Vec3& force) const {
    Row row;
    row.force = force;
    for (int n = 0; n < hinges.count; ++n)
      row.torque -= force.dot(lever[static_cast<std::size_t>(n)]) * hinges.inverse[static_cast<std::size_t>(n)];
    return row;
  }
};

AxisSeries::Chain AxisSeries::chain_at(const SeriesEnd& a, const SeriesEnd& b, double& sine) const {
  Chain chain;
  chain.across_hinge = across_hinge_, chain.across_slider = across_slider_;
  find_angles(a.R.transpose() * b.R * turn_start_.transpose(), chain.x, sine);
  // First with the sliders at 0, in a's frame.
  Mat3 C = Mat3::Identity();
  Vec3 moved = Vec3::Zero();
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const SeriesAxis& axis = axes_[i];
    chain.places[i] = {a.R * (C * axis.axis), C * axis.anchor + moved};
    SeriesDirections& kind = axis.turns ? chain.hinges : chain.sliders;
    if (kind.count == 0) {
      for (Vec3& direction : axis.turns ? chain.across_hinge : chain.across_slider) direction = a.R * (C * direction);
    }
    kind.add(chain.places[i].direction);
    if (!axis.turns) continue;
    const Mat3 turn = turned_about(C * axis.axis, chain.x[i]);
    moved = chain.places[i].anchor + turn * (moved - chain.places[i].anchor), C = turn * C;
  }
  chain.hinges.invert(), chain.sliders.invert();
  const Vec3 beside = b.position - a.position - a.R * (C * centre_b_ + moved);
  Vec3 slid = Vec3::Zero();
  std::size_t slider = 0, hinge = 0;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Chain::Place& place = chain.places[i];
    place.anchor = a.position + a.R * place.anchor + slid;
    if (axes_[i].turns) {
      chain.lever[hinge++] = place.direction.cross(b.position - place.anchor);
    } else {
      chain.x[i] = chain.sliders.inverse[slider++].dot(beside);
      slid += chain.x[i] * place.direction;
    }
  }
  chain.gap = beside - slid, chain.R_b = a.R * C * turn_start_;
  return chain;
}

void AxisSeries::add_rows(const Chain& chain, const SeriesEnd& b, Rows& out) const {
  std::size_t slider = 0, hinge = 0;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Row& row = out.coordinates[i];
    if (axes_[i].turns)
      row.torque = chain.hinges.inverse[hinge++];
    else
      row = chain.along(chain.sliders.inverse[slider++]);
    row.gap = chain.x[i];
  }
  std::array<Vec3, 3> locked;
  const Vec3 sines = sines_of(b.R * chain.R_b.transpose());
  const int turns = across_all(chain.hinges, chain.across_hinge, locked);
  for (int k = 0; k < turns; ++k) {
    Row& row = out.locked[static_cast<std::size_t>(out.count++)];
    row.torque = locked[static_cast<std::size_t>(k)], row.gap = row.torque.dot(sines);
  }
  const int shifts = across_all(chain.sliders, chain.across_slider, locked);
  for (int k = 0; k < shifts; ++k) {
    Row& row = out.locked[static_cast<std::size_t>(out.count++)];
    row = chain.along(locked[static_cast<std::size_t>(k)]), row.gap = row.force.dot(chain.gap);
  }
}

// The bias is what b accelerates by while a's accelerations and those of the
// coordinates are zero.
void AxisSeries::add_rates(const Chain& chain, const SeriesEnd& a, const SeriesEnd& b, Rows& out) const {
  const Vec3 line = b.position - a.position, w = b.angular_velocity - a.angular_velocity,
             v = b.velocity - a.velocity - a.angular_velocity.cross(line);
  const auto set_rate = [&](Row& row) { row.rate = row.force.dot(v) + row.torque.dot(w); };
  for (std::size_t i = 0; i < axes_.size(); ++i) set_rate(out.coordinates[i]);
  for (int k = 0; k < out.count; ++k) set_rate(out.locked[static_cast<std::size_t>(k)]);
  Vec3 turning = a.angular_velocity, angular = Vec3::Zero(), linear = turning.cross(turning.cross(line));
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const Vec3 rate = out.coordinates[i].rate * chain.places[i].direction, change = turning.cross(rate);
    if (!axes_[i].turns) {
      linear += 2 * change;
      continue;
    }
    const Vec3 arm = b.position - chain.places[i].anchor, after = turning + rate;
    linear += change.cross(arm) + after.cross(after.cross(arm)) - turning.cross(turning.cross(arm));
    angular += change, turning = after;
  }
  const auto set_bias = [&](Row& row) { row.bias = -row.force.dot(linear) - row.torque.dot(angular); };
  for (std::size_t i = 0; i < axes_.size(); ++i) set_bias(out.coordinates[i]);
  for (int k = 0; k < out.count; ++k) set_bias(out.locked[static_cast<std::size_t>(k)]);
}

AxisSeries::Rows AxisSeries::at(const SeriesEnd& a, const SeriesEnd& b) const {
  Rows out;
  const Chain chain = chain_at(a, b, out.sine);
  add_rows(chain, b, out);
  add_rates(chain, a, b, out);
  return out;
}

std::vector<SeriesAxis> AxisSeries::axes_at(const SeriesEnd& a, const SeriesEnd& b) const {
  double sine = 1;
  const Chain chain = chain_at(a, b, sine);
  std::vector<SeriesAxis> axes = axes_;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    axes[i].axis = chain.places[i].direction.normalized();
    if (axes[i].turns) axes[i].anchor = chain.places[i].anchor;
  }
  return axes;
}

std::string why_no_series(const std::vector<SeriesAxis>& axes) {
  constexpr double kParallel = 1e-3;  // sine; below it three digits of the coordinates and more are lost
  for (const bool turns : {true, false}) {
    std::vector<Vec3> directions;
    for (const SeriesAxis& axis : axes)
      if (axis.turns == turns) directions.push_back(axis.axis);
    const char* const kind = turns ? "hinges" : "sliders";
    if (directions.size() > kMostSeriesAxesOfAKind)
      return fmt::format("found {} {}; allowed: at most three of them", directions.size(), kind);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j)
        if (directions[i].cross(directions[j]).norm() < kParallel)
          return fmt::format(
              "the {} {} and {} have the same axis; allowed: "
              "each direction once",
              kind, j + 1, i + 1);
    }
    if (directions.size() == 3 && std::abs(directions[0].dot(directions[1].cross(directions[2]))) < kParallel)
      return fmt::format(
          "the axes of its three {} lie in one plane, so one "
          "repeats the others; allowed: independent "
          "directions",
          kind);
  }
  return axes.empty() ? "has no axis; allowed: one to six" : "";
}

}  // namespace rigor::inline scene
