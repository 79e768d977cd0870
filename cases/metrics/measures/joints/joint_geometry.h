// The errors of a joint's two ends, from the bodies' states and the scene alone. Written apart from the core's
// constraints on purpose, so that a mistake there cannot hide here.
#pragma once

#include <optional>
#include "core/engine/body_table.h"

#include "core/scene/joints/axis_series.h"
#include "core/scene/scene.h"

namespace rigor::inline metric {

// What a joint holds, as one of its bodies carries it.
struct JointEnd {
  int body;    // or kWorld
  Vec3 point;  // m, in the body's frame
  Vec3 axis;   // unit, in the body's frame; of no meaning for a joint without an axis
};

// How an end moves; all in W.
struct MovingEnd {
  Mat3 R = Mat3::Identity();
  Quat orientation = Quat::Identity();
  Vec3 centre = Vec3::Zero(), velocity = Vec3::Zero();  // m, m/s
  Vec3 w = Vec3::Zero();                                // rad/s
  Vec3 arm = Vec3::Zero();                              // m, from the centre to the point
  Vec3 axis = Vec3::Zero();

  Vec3 point() const { return centre + arm; }                      // m
  Vec3 point_velocity() const { return velocity + w.cross(arm); }  // m/s
  // m/s: of the place in W as a point of this body
  Vec3 velocity_at(const Vec3& place) const { return velocity + w.cross(place - centre); }
};
MovingEnd end_motion(const JointEnd& end, BodyColumns bodies);

class JointGeometry {
 public:
  JointGeometry(const Scene& scene, const Joint& joint);

  // The points lie on each other at t = 0, but for a distance joint's: the anchor; for slider and fixed b's centre. The
  // axes are a hinge's one axis, a slider's, and a universal joint's two.
  const JointEnd& a() const { return a_; }
  const JointEnd& b() const { return b_; }
  bool holds_angle() const { return holds_ != Angle::none; }
  bool slides() const { return place_ == Place::line; }  // b's point moves along a line of a

  // m: between the points; across the axis where b's point slides along a line, and of a screw along the thread, too;
  // out of a planar joint's plane; of a distance joint ||d| - d0|. Of a compound joint what its axes together do not
  // allow; an axis alone holds nothing.
  double gap(BodyColumns bodies) const;
  // m/s: of the points against each other, in a's frame for sliding and fixed ones; of a distance joint |d'| along it.
  double gap_rate(BodyColumns bodies) const;
  // rad: between a hinge's axes; of the turn of b against a since t = 0 for slider and fixed; by which a universal
  // joint's axes miss the angle of t = 0, a right one. 0 where no angle is held.
  double twist(BodyColumns bodies) const;
  // rad/s: of b against a, but about a hinge's axis; the rate of a universal joint's angle.
  double twist_rate(BodyColumns bodies) const;

  const Quat& start_turn() const { return start_turn_; }  // q_a⁻¹ q_b at t = 0

 private:
  enum class Place { point, line, plane, thread, series, distance, anywhere };
  enum class Angle { none, axis, all, right_angle, series };

  void set_ends(const BodyPose& pose_a, const BodyPose& pose_b, const Joint& joint);
  double series_size(BodyColumns bodies, bool of_turns, double AxisSeries::Row::*what) const;
  double thread_gap(const MovingEnd& a, const MovingEnd& b) const;

  Place place_ = Place::point;
  Angle holds_ = Angle::none;
  JointEnd a_, b_;
  Quat start_turn_ = Quat::Identity();
  std::optional<AxisSeries> series_;  // of a compound joint
  double pitch_ = 0;                  // m, of a screw
  double start_length_ = 0;           // m
  double start_angle_ = 0;            // rad, between the axes
};

// Whether any joint of the scene holds more than places.
bool any_holds_angle(const Scene& scene);

}  // namespace rigor::inline metric
