#include "cases/metrics/measures/contact/impacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cases/metrics/measures/shape_gap.h"
#include "cases/metrics/measures/synchronised.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline metric {
namespace {

using Pair = std::pair<int, int>;

// Speeds in units of the speed that gravity adds between two samples. A flight is seen to approach above kSeen. Each
// impact faster than kCounts has a sample above kSeen, so that roundings at kSeen decide nothing.
constexpr double kSeen = 2, kCounts = 3;
// In the same unit: a body that separates more slowly stays, as far as roundings can tell.
constexpr double kParts = 0.03;
constexpr double kTenth = 0.1;         // of the fastest impact
constexpr double kHair = 1e-6;         // relative: a speed this near a threshold is below it
constexpr double kNoise = 1e-9;        // of the fastest surface: roundings of a speed from two gaps
constexpr double kRoundedGap = 1e-12;  // of a body's size and distance from the origin: a smaller gap is closed

// Two bodies at a sample, and their gap along the free flight through it.
class Flight {
 public:
  Flight(const Scene& scene, BodyColumns bodies, Pair pair)
      : scene_(&scene), pair_(pair), a_(bodies.body(pair.first)), b_(bodies.body(pair.second)) {}

  double gap(double after) const {
    return shape_gap(*body(pair_.first).shape, pose(a_, pair_.first, after), *body(pair_.second).shape,
                     pose(b_, pair_.second, after));
  }
  double rate(double after) const {  // m/s, negative while they approach each other
    constexpr double kStep = 1e-6;   // s; of a gap of metres it leaves nine digits of a speed
    return (gap(after + kStep) - gap(after - kStep)) / (2 * kStep);
  }
  // The first touch within `reach` [s] of the sample, forwards or backwards, if there is one. A flight that only passes
  // near the other body has none. The flight must be apart at the sample.
  std::optional<double> touch(double reach) const {
    const double step = reach / kPieces;
    double gap_before = gap(0), gap_here = gap(step);
    for (int k = 1; k <= kPieces; ++k) {
      if (!(gap_here > 0)) return first_root((k - 1) * step, k * step);
      const double gap_next = k < kPieces ? gap((k + 1) * step) : kFarAway;
      if (gap_here <= gap_before && gap_here <= gap_next && k < kPieces) {
        const double nearest = nearest_between((k - 1) * step, (k + 1) * step);
        if (!(gap(nearest) > 0)) return first_root((k - 1) * step, nearest);
      }
      gap_before = gap_here, gap_here = gap_next;
    }
    return {};
  }
  // m/s, of the gap at the touch after `after` [s], had the bodies the velocities of `other` there.
  double rate_with(const Flight& other, double after) const {
    Flight changed = *this;
    changed.a_ = state(a_, pair_.first, after), changed.b_ = state(b_, pair_.second, after);
    changed.a_.velocity = other.a_.velocity, changed.a_.angular_velocity = other.a_.angular_velocity;
    changed.b_.velocity = other.b_.velocity, changed.b_.angular_velocity = other.b_.angular_velocity;
    return changed.rate(0);
  }

 private:
  const Body& body(int i) const { return scene_->bodies[i]; }
  static constexpr int kPieces = 48;  // of a flight in which touches are looked for
  static constexpr double kFarAway = std::numeric_limits<double>::infinity();

  BodyState state(const BodyState& from, int i, double after) const {
    BodyState moved = from;
    moved.orientation.normalize();
    if (body(i).fixed) return moved;
    moved.position += after * from.velocity + 0.5 * after * after * scene_->gravity;
    moved.velocity += after * scene_->gravity;
    moved.orientation = rotation_by(after * from.angular_velocity) * moved.orientation;
    return moved;
  }
  BodyPose pose(const BodyState& from, int i, double after) const {
    const BodyState moved = state(from, i, after);
    return {moved.position, moved.orientation};
  }
  // Apart at the first instant, and not at the second. Returns an instant at which they are apart.
  double first_root(double apart, double overlapping) const {
    for (int round = 0; round < 60; ++round) {
      const double middle = 0.5 * (apart + overlapping);
      (gap(middle) > 0 ? apart : overlapping) = middle;
    }
    return apart;
  }
  // The instant of the least gap, by golden sections.
  double nearest_between(double from, double to) const {
    constexpr double kGolden = 0.6180339887498949;
    double low = to - kGolden * (to - from), high = from + kGolden * (to - from);
    for (int round = 0; round < 40; ++round) {
      if (gap(low) < gap(high)) {
        to = high, high = low, low = to - kGolden * (to - from);
      } else {
        from = low, low = high, high = from + kGolden * (to - from);
      }
    }
    return 0.5 * (from + to);
  }

  const Scene* scene_;
  Pair pair_;
  BodyState a_, b_;
};

// One pair's series through the samples.
struct Watch {
  std::optional<Flight> approaching;  // the last sample at which they were apart and approached each other
  double since = 0;                   // s, of that sample
  bool hit = false;                   // they stopped approaching after it
  bool is_alone = true;               // no third body has been near either of them since
};

class Watcher {
 public:
  Watcher(const Scene& scene, const Trajectory& trajectory, double stagger)
      : scene_(scene), trajectory_(trajectory), synchroniser_(scene, trajectory, stagger) {
    const auto& samples = trajectory.samples;
    spacing_ = samples.size() > 1 ? samples[1].time - samples[0].time : trajectory.dt;
    of_gravity_ = scene.gravity.norm() * spacing_;
  }

  std::map<Pair, std::vector<ImpactSpeeds>> impacts() {
    for (std::size_t n = 0; n < trajectory_.samples.size(); ++n) look_at(n);
    for (auto& [pair, watch] : watched_) {
      if (watch.hit) conclude(pair, watch, {}, trajectory_.samples.back().time);
    }
    for (auto& [pair, list] : found_) {
      drop_slow(list);
      if (!are_spheres(pair) && list.size() > 1) list.resize(1);
    }
    std::erase_if(found_, [](const auto& entry) { return entry.second.empty(); });
    return std::move(found_);
  }

 private:
  void look_at(std::size_t n) {
    const Sample& sample = trajectory_.samples[n];
    bodies_ = sample.bodies.columns();
    synchroniser_.apply(n, bodies_.columns());
    std::vector<std::pair<Pair, double>> near;
    std::map<int, int> neighbours;  // of each body
    for_each_near_pair(scene_, bodies_.columns(), reach(), [&](int a, int b, double gap) {
      near.push_back({{a, b}, gap});
      ++neighbours[a], ++neighbours[b];
    });
    for (const auto& [pair, gap] : near) {
      const bool is_alone = alone(pair.first, neighbours) && alone(pair.second, neighbours);
      look_at_pair(pair, gap, is_alone, sample.time);
    }
  }

  // Whether nothing else could touch the body before this impact is over; a fixed one does not mind.
  bool alone(int body, const std::map<int, int>& neighbours) const {
    return scene_.bodies[body].fixed || neighbours.at(body) == 1;
  }

  // m, from which two bodies can meet within two samples; it never falls, so that a pair at rest is still seen.
  double reach() {
    const BodyColumns now = static_cast<const BodyTable&>(bodies_).columns();
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (!scene_.bodies[i].collides || scene_.bodies[i].fixed) continue;
      const double turning = now.angular_velocity(i).norm() * bounding_radius(*scene_.bodies[i].shape);
      fastest_ = std::max(fastest_, now.velocity(i).norm() + turning);
    }
    return 2 * spacing_ * (2 * fastest_ + kSeen * of_gravity_);
  }

  double rounded_gap(const Pair& pair) const {
    const BodyColumns now = static_cast<const BodyTable&>(bodies_).columns();
    double size = 0;
    for (const int i : {pair.first, pair.second}) {
      if (std::isfinite(bounding_radius(*scene_.bodies[i].shape)))
        size = std::max(size, now.position(i).norm() + bounding_radius(*scene_.bodies[i].shape));
    }
    return kRoundedGap * size;
  }

  void look_at_pair(const Pair& pair, double gap, bool is_alone, double time) {
    const Flight flight(scene_, static_cast<const BodyTable&>(bodies_).columns(), pair);
    const double rate = flight.rate(0), noise = kNoise * fastest_;
    const bool are_apart = gap > rounded_gap(pair), approach = rate < -kSeen * of_gravity_ - noise;
    Watch& watch = watched_[pair];
    watch.is_alone = watch.is_alone && is_alone;  // at each sample until it is over
    if (approach && are_apart) {
      if (watch.hit) conclude(pair, watch, {}, time);
      watch = {flight, time, false, is_alone};
    } else if (watch.approaching && !approach) {
      watch.hit = true;
      if (are_apart && rate > kParts * of_gravity_ + noise) conclude(pair, watch, flight, time);
    }
  }

  // `leaving`: the first flight apart again; none if they stay together until they approach anew.
  void conclude(const Pair& pair, Watch& watch, const std::optional<Flight>& leaving, double time) {
    if (watch.is_alone) {
      if (const auto impact = impact_between(*watch.approaching, watch.since, leaving, time))
        found_[pair].push_back(*impact);
    }
    watch = {};
  }

  // None where the bodies only pass each other: the flight does not touch, or goes on as it was. An impact of any
  // restitution takes all of the speed of approach at least, and half of that tells it from none.
  std::optional<ImpactSpeeds> impact_between(const Flight& approaching, double since,
                                             const std::optional<Flight>& leaving, double time) const {
    const double range = 3 * spacing_;  // an impact is seen a step late, and left a step after that
    const auto in = approaching.touch(range);
    if (!in) return {};
    ImpactSpeeds impact{since + *in, -approaching.rate(*in), 0};
    if (!leaving) return impact;
    if (approaching.rate_with(*leaving, *in) < -0.5 * impact.before) return {};
    const auto out = leaving->touch(-range);
    impact.time = out ? time + *out : impact.time;
    impact.after = out ? leaving->rate(*out) : std::max(0.0, leaving->rate(0));
    return impact;
  }

  bool is_round(int body) const {
    const Shape& shape = *scene_.bodies[body].shape;
    return std::holds_alternative<Sphere>(shape) || std::holds_alternative<Plane>(shape);
  }
  bool are_spheres(const Pair& pair) const { return is_round(pair.first) && is_round(pair.second); }

  void drop_slow(std::vector<ImpactSpeeds>& list) const {
    double fastest = 0;
    for (const ImpactSpeeds& impact : list) fastest = std::max(fastest, impact.before);
    const double least = std::max(kCounts * of_gravity_, kTenth * fastest) * (1 + kHair);
    std::erase_if(list, [&](const ImpactSpeeds& impact) { return impact.before <= least; });
  }

  const Scene& scene_;
  const Trajectory& trajectory_;
  Synchroniser synchroniser_;
  double spacing_, of_gravity_;  // s between samples; m/s, the speed that gravity adds in that time
  double fastest_ = 0;           // m/s, that a surface has moved so far
  BodyTable bodies_;
  std::map<Pair, Watch> watched_;
  std::map<Pair, std::vector<ImpactSpeeds>> found_;
};

}  // namespace

std::map<Pair, std::vector<ImpactSpeeds>> impacts_of(const Scene& scene, const Trajectory& trajectory,
                                                     double leapfrog_stagger) {
  if (trajectory.samples.empty() || !anything_can_touch(scene)) return {};
  return Watcher(scene, trajectory, leapfrog_stagger).impacts();
}

}  // namespace rigor::inline metric
