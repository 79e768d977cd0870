#include "cases/analysis/divergence/injections.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "cases/analysis/divergence/rebased_scene.h"

namespace rigor::inline analysis {
namespace {

constexpr std::size_t kEven = 400, kSudden = 100;  // steps that are looked at if there are too many for all

// A step in which the gap of velocities jumps holds an event of one run, or of both.
double jump_at(const MotionView& a, const MotionView& b, const Scene& scene, std::size_t n) {
  double most = 0;
  for (std::size_t i = 0; i < a.bodies(); ++i) {
    if (scene.bodies[i].fixed) continue;
    const BodyGap before = gap_between(a.body(n, i), b.body(n, i)),
                  after = gap_between(a.body(n + 1, i), b.body(n + 1, i));
    most = std::max(most, (after.velocity - before.velocity).norm());
  }
  return most;
}

// The samples from which steps are looked at.
std::vector<std::size_t> chosen_steps(const MotionView& a, const MotionView& b, const Scene& scene, std::size_t steps) {
  std::set<std::size_t> chosen;
  if (steps <= kEven + kSudden) {
    for (std::size_t n = 0; n < steps; ++n) chosen.insert(n);
    return {chosen.begin(), chosen.end()};
  }
  for (std::size_t k = 0; k < kEven; ++k) chosen.insert(k * steps / kEven);
  std::vector<std::size_t> by_jump(steps);
  std::iota(by_jump.begin(), by_jump.end(), 0);
  std::vector<double> jumps;
  for (std::size_t n = 0; n < steps; ++n) jumps.push_back(jump_at(a, b, scene, n));
  std::partial_sort(by_jump.begin(), by_jump.begin() + kSudden, by_jump.end(),
                    [&](std::size_t x, std::size_t y) { return jumps[x] > jumps[y]; });
  chosen.insert(by_jump.begin(), by_jump.begin() + kSudden);
  return {chosen.begin(), chosen.end()};
}

struct WorstShare {
  double share = 0;
  int body = 0;
  BodyGap gap;
  std::size_t alike = 0;  // other bodies
};

// Of states after one step, `x` and `y`, carried on for `seconds`.
WorstShare worst_share(const std::vector<BodyState>& x, const std::vector<BodyState>& y, const Scene& scene,
                       const PartingBounds& bounds, double seconds) {
  constexpr double kAlike = 0.99;
  WorstShare worst;
  std::vector<double> shares;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (scene.bodies[i].fixed) continue;
    const BodyGap gap = gap_between(x[i], y[i]);
    shares.push_back(share_of(gap.carried(seconds), bounds));
    if (shares.back() > worst.share) worst = {shares.back(), static_cast<int>(i), gap, 0};
  }
  const auto alike = std::count_if(shares.begin(), shares.end(), [&](double s) { return s >= kAlike * worst.share; });
  if (worst.share > 0) worst.alike = static_cast<std::size_t>(alike) - 1;
  return worst;
}

// The part of the gap at the parting that the sum of the injections of its body makes.
double injected_part(const std::vector<BodyGap>& gaps, const std::vector<Injection>& steps, std::size_t all,
                     const Parting& parting, const BodyGap& at_parting) {
  BodyGap sum;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const std::size_t next = k + 1 < steps.size() ? steps[k + 1].sample : all;
    // A step that is looked at stands for those until the next one.
    sum += gaps[k] * static_cast<double>(next - steps[k].sample);
  }
  const auto part = [](const Vec3& of, const Vec3& whole) {
    return whole.squaredNorm() > 0 ? of.dot(whole) / whole.squaredNorm() : 0;
  };
  if (parting.unit == "m") return part(sum.position, at_parting.position);
  if (parting.unit == "rad") return part(sum.turn, at_parting.turn);
  if (parting.unit == "m/s") return part(sum.velocity, at_parting.velocity);
  return part(sum.angular_velocity, at_parting.angular_velocity);
}

Scene nudged_scene(const Scene& scene, double size) {
  constexpr double kNudge = 1e-8;  // of the size: far above rounding, far below any bound
  Scene out = scene;
  for (Body& body : out.bodies) {
    if (!body.fixed) body.position += kNudge * size * Vec3(1, -1, 1).normalized();
  }
  return out;
}

double distance_of(const MotionView& a, const MotionView& b, const Scene& scene, double size, std::size_t n) {
  double most = 0;
  for (std::size_t i = 0; i < a.bodies(); ++i) {
    if (scene.bodies[i].fixed) continue;
    const BodyGap gap = gap_between(a.body(n, i), b.body(n, i));
    most = std::max(most, std::hypot(gap.position.norm() / size, gap.turn.norm()));
  }
  return most;
}

void measure_growth(const RunPair& pair, const Scene& scene, const MotionView& motion, const Parting& parting,
                    Injections& found) {
  const double size = scene_size(scene);
  const auto nudged = std::make_shared<Scene>(nudged_scene(scene, size));
  const std::vector<StateSeries> runs =
      pair.motions({pair.task(RunPair::Side::a, nudged, static_cast<long>(parting.sample))});
  const MotionView view(runs[0], motion.bodies());
  if (!runs[0].why.empty() || view.samples() <= parting.sample || parting.time <= 0) return;
  const double start = distance_of(motion, view, scene, size, 0),
               end = distance_of(motion, view, scene, size, parting.sample);
  if (start <= 0 || end <= 0) return;
  found.growth_factor = end / start, found.growth = std::log(end / start) / parting.time;
}

// The one-step difference of the body that parts, carried until the parting.
BodyGap carried_gap(const std::vector<BodyState>& x, const std::vector<BodyState>& y, int body, double seconds) {
  const auto i = static_cast<std::size_t>(body);
  return gap_between(x[i], y[i]).carried(seconds);
}

}  // namespace

std::vector<std::shared_ptr<const Scene>> scenes_at(const Scene& scene, const MotionView& motion,
                                                    const std::vector<std::size_t>& samples, double seconds) {
  std::vector<std::shared_ptr<const Scene>> scenes;
  JointCoordinates coordinates(scene);
  std::size_t n = 0;
  for (const std::size_t sample : samples) {
    for (; n <= sample; ++n) coordinates.follow(motion.state(n));
    scenes.push_back(std::make_shared<Scene>(
        rebased(scene, motion.state(sample), coordinates.values(), seconds * static_cast<double>(sample))));
  }
  return scenes;
}

Injections find_injections(const RunPair& pair, const Scene& scene, const MotionView& motion_a,
                           const MotionView& motion_b, const PartingBounds& bounds, const Parting& parting) {
  Injections found;
  const double h = pair.steps().seconds;
  const std::vector<std::size_t> steps = chosen_steps(motion_a, motion_b, scene, parting.sample);
  found.has_all_steps = steps.size() == parting.sample;
  const auto of_a = scenes_at(scene, motion_a, steps, h), of_b = scenes_at(scene, motion_b, steps, h);
  std::vector<MotionTask> tasks;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    tasks.push_back(pair.task(RunPair::Side::a, of_a[k], 1)), tasks.push_back(pair.task(RunPair::Side::b, of_a[k], 1));
    tasks.push_back(pair.task(RunPair::Side::b, of_b[k], 1));
  }
  const std::vector<StateSeries> after = pair.motions(tasks);
  std::vector<BodyGap> gaps;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const StateSeries *x = &after[3 * k], *y = x + 1, *z = x + 2;
    for (const StateSeries* one : {x, y, z}) {
      if (!one->why.empty()) found.why = one->why;
    }
    const auto ends = [&](const StateSeries* of) { return MotionView(*of, scene.bodies.size()).samples() > 1; };
    if (!ends(x) || !ends(y) || !ends(z)) continue;
    const auto end_of = [&](const StateSeries* of) { return MotionView(*of, scene.bodies.size()).state(1); };
    const double left = parting.time - h * static_cast<double>(steps[k] + 1);
    const WorstShare worst = worst_share(end_of(x), end_of(y), scene, bounds, left),
                     in_a = worst_share(end_of(x), motion_a.state(steps[k] + 1), scene, bounds, left),
                     in_b = worst_share(end_of(z), motion_b.state(steps[k] + 1), scene, bounds, left);
    found.steps.push_back({h * static_cast<double>(steps[k]), steps[k], worst.body, worst.share, worst.alike, worst.gap,
                           in_a.share, in_b.share, in_a.body, in_b.body});
    gaps.push_back(carried_gap(end_of(x), end_of(y), parting.body, left));
  }
  if (found.steps.empty()) return found;
  found.why.clear();
  const auto at = static_cast<std::size_t>(parting.body);
  found.injected = injected_part(gaps, found.steps, parting.sample, parting,
                                 gap_between(motion_a.body(parting.sample, at), motion_b.body(parting.sample, at)));
  measure_growth(pair, scene, motion_a, parting, found);
  return found;
}

std::vector<Injection> largest_injections(const Injections& injections, std::size_t most) {
  constexpr double kOfLargest = 0.01;     // smaller ones explain nothing of the gap
  constexpr std::size_t kStepsApart = 5;  // steps: an engine may spread one event over some steps
  std::vector<Injection> by_size = injections.steps, chosen;
  // Gravity, for example, gives every step the same difference but for roundings.
  const auto four_digits = [](double share) {
    int exponent = 0;
    const double mantissa = std::frexp(share, &exponent);
    return std::ldexp(std::round(1e4 * mantissa), exponent);
  };
  std::stable_sort(by_size.begin(), by_size.end(),
                   [&](const auto& x, const auto& y) { return four_digits(x.share) > four_digits(y.share); });
  for (const Injection& one : by_size) {
    const bool is_near = std::any_of(chosen.begin(), chosen.end(), [&](const Injection& other) {
      return std::max(one.sample, other.sample) - std::min(one.sample, other.sample) < kStepsApart;
    });
    if (is_near || one.share <= kOfLargest * by_size.front().share) continue;
    chosen.push_back(one);
    if (chosen.size() == most) break;
  }
  return chosen;
}

}  // namespace rigor::inline analysis
