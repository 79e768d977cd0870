// How far a part of a step may go while contact lasts: as slips, turns of bodies and rims allow.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/dynamics/contact/event/features/round_surface.h"
#include "core/dynamics/contact/event/persistent/persistent_contact.h"

namespace rigor::inline dynamics {
namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();
constexpr double kShortest = 1e-4;   // of time: the shortest step that slips ask for
constexpr double kFollowing = 1e-3;  // of time: the same, of an adaptive method that follows a slip
constexpr double kStable = 2;        // a step of an explicit method, in units of the time that it damps
constexpr double kEasy = 0.05;       // the same: a longer step errs where a slip turns
constexpr double kFollowed = 4;      // the same, of an adaptive method that follows a slip
constexpr double kStraight = 1e-9;   // rad: a slip that turns less in a step is straight
constexpr double kTurn = 0.25;       // rad, of a body among joints in a step of an explicit method
constexpr double kTurnOfRim = 0.5;   // rad, of the contact about a rim in a step, seen in W

}  // namespace

// 1/s: how fast friction damps what slips across the direction of sliding. Infinite where the slip begins.
double PersistentContact::damping_rate(const PersistentPoint& point) const {
  if (point.mode != PersistentPoint::Mode::slides || point.friction() == 0) return 0;
  const double slip = point.begins_to_slip ? 0 : point.velocity.tail<2>().norm();
  const double force = point.friction() * point.force.x();
  return force > 0 ? force / (point.tangential_mass * slip) : 0;
}

double PersistentContact::choose_step(BodyColumns state, double length) {
  double fastest = 0;
  bool turns = false;
  for (const PersistentPoint& point : points()) {
    const double rate = damping_rate(point);
    const bool turns_here = point.begins_to_slip || point.turn_rate * length > kStraight;
    turns = turns || (!in_contact_.adaptive && rate * length > kEasy && turns_here);
    if (turns || std::isfinite(rate)) fastest = std::max(fastest, rate);
  }
  follows_turning_slip_ = turns, fastest_damping_ = fastest;
  const double shortest = (follows_turning_slip_ ? kFollowing : kShortest) * scales().time;
  const double followed = follows_turning_slip_ ? kFollowed : kStable;
  const double of_slips = fastest > 0 ? std::max(shortest, followed / fastest) : kNoBound;
  return std::min({length, of_slips, longest_turn(state), longest_way_of_rims(state)});
}

// s: a rim that has turned over is told from one that lies elsewhere by the direction in which its contact began.
double PersistentContact::longest_way_of_rims(BodyColumns state) const {
  double longest = kNoBound;
  for (const PersistentPoint& point : points()) {
    for (const auto& [feature, body] :
         {std::pair(&point.features.a, point.contact.cone.a), {&point.features.b, point.contact.cone.b}}) {
      if (feature->kind != ContactFeature::Kind::round || !is_rim(feature->half_axes)) continue;
      const Vec3 arm = state.orientation(body) * feature->at;
      const Vec3 centre_rate = state.velocity(body) + state.angular_velocity(body).cross(arm);
      const double rate = (point.kinematics.point_rate - centre_rate).norm() / feature->half_axes.col(0).norm();
      longest = std::min(longest, std::max(kTurnOfRim / rate, kShortest * scales().time));
    }
  }
  return longest;
}

// An explicit method becomes unstable if a jointed body rotates further than this in a step. Small links rotate fast
// after impacts.
double PersistentContact::longest_turn(BodyColumns state) const {
  if (!joints_ || is_adaptive()) return kNoBound;
  double fastest = 0;
  for (std::size_t i = 0; i < state.size(); ++i) fastest = std::max(fastest, state.angular_velocity(i).norm());
  return kTurn / fastest;
}

}  // namespace rigor::inline dynamics
