// The motion of a body b relative to a that axes in series allow (compound_joint.h): their coordinates, the rows of
// these and of the motions that stay locked, at any pose. With V = (v, w) of b's centre relative to a, carried along:
//   w = sum h_i x_i'              over the hinges, h_i their axes now
//   v = sum h_i x r_i x_i' + sum d_j x_j'    over hinges and sliders, r_i from the hinge's anchor to b's centre
// so hinge rates are H⁺ w and slider rates D⁺ (v - sum h_i x r_i x_i'). Locked are the directions across all h and,
// with that v, across all d. Angles follow from the relative rotation R = exp(h_1 x_1) exp(h_2 x_2) exp(h_3 x_3). Two
// solutions exist for three hinges; it is the one that the start is continuous with, between two positions where the
// first and the last hinge are parallel (P. Davenport, 1973).
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "core/scene/body_pose.h"
#include "core/scene/joints/compound_joint.h"

namespace rigor::inline scene {

struct SeriesEnd {  // of a or b, in W
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
  Mat3 R = Mat3::Identity();
};

class AxisSeries {
 public:
  // Poses of a and b at t = 0. At most three hinges and three sliders, each with independent directions.
  AxisSeries(const std::vector<SeriesAxis>& axes, const BodyPose& a, const BodyPose& b);

  // A row J V: force . v_b + torque . w_b - force . v_a - (torque + line x force) . w_a, line from a's centre to b's.
  struct Row {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    double gap = 0;   // of a locked row [m, rad]; of a coordinate its value [rad, m], angles from -pi to pi
    double rate = 0;  // J V
    double bias = 0;  // J' V
  };
  struct Rows {
    std::array<Row, kMostSeriesAxes> coordinates;  // as the axes
    std::array<Row, 6> locked;
    int count = 0;    // of the locked ones
    double sine = 1;  // of the middle of three hinges: 0 where the first and the last are parallel
  };
  Rows at(const SeriesEnd& a, const SeriesEnd& b) const;
  // The axes at a pose, in W: the first as a carries it, each other one as the axes before it do.
  std::vector<SeriesAxis> axes_at(const SeriesEnd& a, const SeriesEnd& b) const;
  int locked() const { return 6 - static_cast<int>(axes_.size()); }

 private:
  struct Chain;
  void find_angles(const Mat3& turn, std::array<double, kMostSeriesAxes>& x, double& sine) const;
  Chain chain_at(const SeriesEnd& a, const SeriesEnd& b, double& sine) const;
  void add_rows(const Chain& chain, const SeriesEnd& b, Rows& out) const;
  void add_rates(const Chain& chain, const SeriesEnd& a, const SeriesEnd& b, Rows& out) const;

  std::vector<SeriesAxis> axes_;      // in a's frame, as at t = 0
  std::vector<std::size_t> hinges_;   // of the axes
  std::array<Vec3, 2> across_hinge_;  // the first hinge's, in a's frame at t = 0
  std::array<Vec3, 2> across_slider_;
  Vec3 centre_b_;    // in a's frame at t = 0
  Mat3 turn_start_;  // b's axes in a's frame at t = 0
};

// "" if such axes can stand in series, else why they cannot.
std::string why_no_series(const std::vector<SeriesAxis>& axes);

}  // namespace rigor::inline scene
