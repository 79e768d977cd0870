#include "cases/metrics/measures/impacts.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cases/metrics/measures/shape_gap.h"
#include "cases/metrics/measures/synchronised.h"
#include "core/scene/contact_laws.h"

namespace rigor {
namespace {

using Pair = std::pair<int, int>;

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
  // When they touch, within `reach` [s] of the sample, forwards or backwards; the flight must be apart at the sample.
  std::optional<double> touch(double reach) const {
    double apart = 0, overlapping = reach;
    if (gap(reach) > 0) return {};
    for (int round = 0; round < 60; ++round) {
      const double middle = 0.5 * (apart + overlapping);
      (gap(middle) > 0 ? apart : overlapping) = middle;
    }
    return apart;
  }

 private:
  const Body& body(int i) const { return scene_->bodies[i]; }
  BodyPose pose(const BodyState& state, int i, double after) const {
    const Quat q = state.orientation.normalized();
    if (body(i).fixed) return {state.position, q};
    return {state.position + after * state.velocity + 0.5 * after * after * scene_->gravity,
            rotation_by(after * state.angular_velocity) * q};
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
      : scene_(scene), trajectory_(trajectory), synchroniser_(scene, trajectory.dt, stagger) {
    const auto& samples = trajectory.samples;
    spacing_ = samples.size() > 1 ? samples[1].time - samples[0].time : trajectory.dt;
    slowest_ = 2 * scene.gravity.norm() * spacing_;
  }

  std::map<Pair, std::vector<ImpactSpeeds>> impacts() {
    for (const Sample& sample : trajectory_.samples) look_at(sample);
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
  void look_at(const Sample& sample) {
    bodies_ = sample.bodies.columns();
    synchroniser_.apply(sample.time, bodies_.columns());
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
    return 2 * spacing_ * (2 * fastest_ + slowest_);
  }

  void look_at_pair(const Pair& pair, double gap, bool is_alone, double time) {
    const Flight flight(scene_, static_cast<const BodyTable&>(bodies_).columns(), pair);
    const double rate = flight.rate(0);
    Watch& watch = watched_[pair];
    watch.is_alone = watch.is_alone && is_alone;  // at each sample until it is over
    if (rate < -slowest_ && gap > 0) {
      if (watch.hit) conclude(pair, watch, {}, time);
      watch = {flight, time, false, is_alone};
    } else if (watch.approaching && rate >= -slowest_) {
      watch.hit = true;
      if (gap > 0 && rate > 0) conclude(pair, watch, flight, time);
    }
  }

  // `leaving`: the first flight apart again; none if they stay together until they approach anew.
  void conclude(const Pair& pair, Watch& watch, const std::optional<Flight>& leaving, double time) {
    const double range = 3 * spacing_;  // an impact is seen a step late, and left a step after that
    const double in = watch.approaching->touch(range).value_or(0);
    ImpactSpeeds impact{watch.since + in, -watch.approaching->rate(in), 0};
    if (leaving) {
      const double out = leaving->touch(-range).value_or(0);
      impact.time = time + out, impact.after = leaving->rate(out);
    }
    if (watch.is_alone) found_[pair].push_back(impact);
    watch = {};
  }

  bool is_round(int body) const {
    const Shape& shape = *scene_.bodies[body].shape;
    return std::holds_alternative<Sphere>(shape) || std::holds_alternative<Plane>(shape);
  }
  bool are_spheres(const Pair& pair) const { return is_round(pair.first) && is_round(pair.second); }

  static void drop_slow(std::vector<ImpactSpeeds>& list) {
    double fastest = 0;
    for (const ImpactSpeeds& impact : list) fastest = std::max(fastest, impact.before);
    constexpr double kTenth = 0.1;
    std::erase_if(list, [&](const ImpactSpeeds& impact) { return impact.before < kTenth * fastest; });
  }

  const Scene& scene_;
  const Trajectory& trajectory_;
  Synchroniser synchroniser_;
  double spacing_, slowest_;  // s between samples; m/s, what gravity adds in two of them: a slower body rests
  double fastest_ = 0;        // m/s, that a surface has moved so far
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

}  // namespace rigor
