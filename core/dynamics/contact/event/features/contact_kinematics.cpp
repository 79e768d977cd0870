#include "core/dynamics/contact/event/features/contact_kinematics.h"

#include <Eigen/LU>

#include "core/dynamics/collision/curved/curved_solid.h"
#include "core/dynamics/contact/event/features/round_surface.h"

namespace rigor::inline dynamics {
namespace {

using Kind = ContactFeature::Kind;

struct Moving {  // a feature in W
  Vec3 p, v;     // of `at`
  Vec3 d, rate;  // `direction`
  double radius;
};

Moving moving(const ContactFeature& feature, const RigidMotion& body) {
  const Vec3 arm = body.pose.R * feature.at, d = body.pose.R * feature.direction;
  return {body.pose.p + arm, body.v + body.w.cross(arm), d, body.w.cross(d), feature.radius};
}

// A unit vector along `line`, and its rate of change.
struct Direction {
  Vec3 n, rate;
  double length;
};
Direction direction_of(const Vec3& line, const Vec3& rate) {
  const double length = line.norm();
  const Vec3 n = line / length;
  return {n, (rate - n * n.dot(rate)) / length, length};
}

ContactKinematics point_on_plane(const Moving& point, const Moving& plane) {
  const Vec3& n = plane.d;
  const double gap = n.dot(point.p - plane.p) - point.radius;
  return {n, point.p - (point.radius + 0.5 * gap) * n, gap, plane.rate, point.v - point.radius * plane.rate};
}

ContactKinematics point_on_point(const Moving& a, const Moving& b) {
  const Direction line = direction_of(a.p - b.p, a.v - b.v);
  const double gap = line.length - a.radius - b.radius;
  return {line.n, b.p + (b.radius + 0.5 * gap) * line.n, gap, line.rate, b.v + b.radius * line.rate};
}

ContactKinematics point_on_line(const Moving& point, const Moving& line) {
  const Vec3 from = point.p - line.p;
  const double s = line.d.dot(from), s_rate = line.rate.dot(from) + line.d.dot(point.v - line.v);
  const Moving foot{line.p + s * line.d, line.v + s_rate * line.d + s * line.rate, {}, {}, line.radius};
  return point_on_point(point, foot);
}

// From a + s ea = b + t eb + D n and its derivative.
ContactKinematics line_on_line(const Moving& a, const Moving& b, double side) {
  const Direction across = direction_of(side * a.d.cross(b.d), side * (a.rate.cross(b.d) + a.d.cross(b.rate)));
  const Vec3& n = across.n;
  Mat3 directions;
  directions << a.d, -b.d, -n;
  const Mat3 inverse = directions.inverse();
  const Vec3 at = inverse * (b.p - a.p);
  const Vec3 rate = inverse * (b.v - a.v - at[0] * a.rate + at[1] * b.rate + at[2] * across.rate);
  const double gap = at[2] - a.radius - b.radius;
  return {n, b.p + at[1] * b.d + (b.radius + 0.5 * gap) * n, gap, across.rate,
          b.v + rate[1] * b.d + at[1] * b.rate + b.radius * across.rate};
}

ContactKinematics reversed(ContactKinematics kinematics) {
  kinematics.normal *= -1, kinematics.normal_rate *= -1;
  return kinematics;
}

// A round surface, placed in W.
struct Round {
  Vec3 centre, v, w;
  Mat3 half_axes;
  Vec3 began;  // of a rim: the direction of its contact when that began

  Round(const ContactFeature& feature, const RigidMotion& body)
      : w(body.w), half_axes(body.pose.R * feature.half_axes), began(feature.direction) {
    const Vec3 arm = body.pose.R * feature.at;
    centre = body.pose.p + arm, v = body.v + body.w.cross(arm);
  }

  // The point whose outward normal is m. That of a rim which lies flat is the one on the side where the contact began.
  // A rim that turns over past that keeps it until the end of its contact is found (feature_ends.h).
  RoundPoint point(const Vec3& m) const {
    if (!is_rim(half_axes)) return point_with_normal(half_axes, m);
    const double radius = half_axes.col(0).norm(), tilt = (half_axes.transpose() * m).norm() / radius;
    if (tilt < kUpright) return {radius * (half_axes * (half_axes.transpose() * began)).normalized(), Mat3::Zero()};
    RoundPoint at = point_with_normal(half_axes, m);
    if (at.at.dot(began) < 0) at.at *= -1, at.by_turns *= -1;
    return at;
  }
};

// The normal on the surface is -n, which is fixed in the plane's frame.
ContactKinematics round_on_plane(const Round& round, const Moving& plane) {
  const Vec3& n = plane.d;
  const RoundPoint touch = round.point(-n);
  const Vec3 turn = round.w.cross(n) - plane.rate;  // of the normal, as the round body sees it
  const double gap = n.dot(round.centre + touch.at - plane.p);
  return {n, round.centre + touch.at - 0.5 * gap * n, gap, plane.rate,
          round.v + round.w.cross(touch.at) + touch.by_turns * turn};
}

// The ball's centre is at s(m) + d m, as the round body sees it. If it moves by dc, dc = (S + d) dm + m dd.
ContactKinematics round_on_ball(const Round& round, const Moving& ball) {
  const Vec3 to_ball = ball.p - round.centre, foot = nearest_point(round.half_axes, to_ball);
  const Direction line = direction_of(to_ball - foot, Vec3::Zero());
  const Vec3& m = line.n;
  const RoundPoint touch = point_with_normal(round.half_axes, m);
  const Vec3 moved = ball.v - round.v - round.w.cross(to_ball);
  const Mat3 bends = touch.by_turns + line.length * Mat3::Identity();
  const Vec3 turn = bends.inverse() * (moved - m * m.dot(moved));
  const double gap = line.length - ball.radius;
  return {-m, round.centre + foot + 0.5 * gap * m, gap, -(round.w.cross(m) + turn),
          round.v + round.w.cross(foot) + touch.by_turns * turn};
}

ContactKinematics round_on(const ContactFeature& round, const RigidMotion& a, const ContactFeature& other,
                           const RigidMotion& b) {
  const Moving beside = moving(other, b);
  return other.kind == Kind::plane ? round_on_plane({round, a}, beside) : round_on_ball({round, a}, beside);
}

}  // namespace

ContactKinematics contact_kinematics(const FeaturePair& features, const RigidMotion& a, const RigidMotion& b) {
  const Kind kind_a = features.a.kind, kind_b = features.b.kind;
  if (kind_a == Kind::round) return round_on(features.a, a, features.b, b);
  if (kind_b == Kind::round) return reversed(round_on(features.b, b, features.a, a));
  const Moving of_a = moving(features.a, a), of_b = moving(features.b, b);
  if (kind_b == Kind::plane) return point_on_plane(of_a, of_b);
  if (kind_a == Kind::plane) return reversed(point_on_plane(of_b, of_a));
  if (kind_a == Kind::line && kind_b == Kind::line) return line_on_line(of_a, of_b, features.side);
  if (kind_b == Kind::line) return point_on_line(of_a, of_b);
  if (kind_a == Kind::line) return reversed(point_on_line(of_b, of_a));
  return point_on_point(of_a, of_b);
}

}  // namespace rigor::inline dynamics
