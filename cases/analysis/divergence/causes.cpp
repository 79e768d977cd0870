#include "cases/analysis/divergence/causes.h"

#include <algorithm>
#include <cmath>

#include "cases/analysis/divergence/ablations.h"

namespace rigor::inline analysis {
namespace {

constexpr std::size_t kMostParts = 60;  // taken away, one at a time: some tenths of a second
constexpr double kShareNamed = 0.5;     // a part is named that takes at least half of the difference with it
constexpr double kSharesAlike = 0.05;   // shares that differ by less say the same,
constexpr double kMuchLess = 10;        // but not if one part leaves so many times less than the other,
constexpr double kRestAlike = 0.01;     // unless both leave next to nothing
constexpr double kFewRoundings = 64;    // of a step's sums

// The share of the bound by which the body differs in two motions after one sample, or any body if it is kWorld.
// Negative if one of the motions failed.
double share_after(const StateSeries& x, const StateSeries& y, const Scene& scene, const PartingBounds& bounds,
                   int body, double seconds) {
  const MotionView in_x(x, scene.bodies.size()), in_y(y, scene.bodies.size());
  if (!x.why.empty() || !y.why.empty() || in_x.samples() < 2 || in_y.samples() < 2) return -1;
  double most = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const bool is_asked = body == kWorld ? !scene.bodies[i].fixed : static_cast<int>(i) == body;
    if (is_asked)
      most = std::max(most, share_of(gap_between(in_x.body(1, i), in_y.body(1, i)).carried(seconds), bounds));
  }
  return most;
}

double unit_roundoff(const RunPair& pair) {
  double most = 0x1p-53;
  for (const auto side : {RunPair::Side::a, RunPair::Side::b}) {
    const EngineInfo& info = pair.engines().info_of(pair.run(side).name.engine);
    if (info.precision == "single") most = 0x1p-24;
  }
  return most;
}

// The share of the bound that rounding of the body's own numbers makes.
double share_of_rounding(const BodyState& state, const PartingBounds& bounds, double seconds, double roundoff) {
  const BodyGap rounded{Vec3(state.position.norm(), 0, 0), Vec3(1, 0, 0), Vec3(state.velocity.norm(), 0, 0),
                        Vec3(state.angular_velocity.norm(), 0, 0)};
  return share_of((rounded * roundoff).carried(seconds), bounds);
}

// Of parts that explain it alike the one with the smallest rank. A part that leaves much less than all others is named
// before them: the load that differs, and not the friction that it overcomes. General parts never count as such.
void name_cause(Cause& cause) {
  std::stable_sort(cause.evidence.begin(), cause.evidence.end(),
                   [](const Evidence& x, const Evidence& y) { return x.share > y.share; });
  const auto first =
      std::find_if(cause.evidence.begin(), cause.evidence.end(), [](const Evidence& one) { return !one.is_general; });
  const double least = first == cause.evidence.end() ? 1 : 1 - first->share;
  const double alike = std::max(kRestAlike, kMuchLess * least);
  const Evidence* best = nullptr;
  for (const Evidence& one : cause.evidence) {
    if (one.share < kShareNamed || one.share < cause.evidence.front().share - kSharesAlike) break;
    if (!one.is_general && 1 - one.share > alike) continue;
    if (!best || one.rank < best->rank) best = &one;
  }
  if (best) cause.what = best->what, cause.detail = best->detail, cause.share = best->share;
}

// The tasks of one injection: as loaded, in half steps, and without each part.
struct CauseTasks {
  std::vector<Ablation> parts;
  std::size_t first = 0;  // of the tasks
};

}  // namespace

std::vector<Cause> find_causes(const RunPair& pair, const Scene& scene, const MotionView& motion_a,
                               const PartingBounds& bounds, const Parting& parting,
                               const std::vector<Injection>& injections) {
  std::vector<MotionTask> tasks;
  std::vector<CauseTasks> groups;
  const double h = pair.steps().seconds;
  for (const Injection& one : injections) {
    const auto loaded = scenes_at(scene, motion_a, {one.sample}, h).front();
    const AblatedStep step{*loaded, motion_a.state(one.sample), motion_a.state(one.sample + 1), h, one.body};
    groups.push_back({ablations_of(step, kMostParts), tasks.size()});
    for (const long finer : {1L, 2L}) {
      for (const auto side : {RunPair::Side::a, RunPair::Side::b}) tasks.push_back(pair.task(side, loaded, 1, finer));
    }
    for (const Ablation& part : groups.back().parts) {
      for (const auto side : {RunPair::Side::a, RunPair::Side::b}) tasks.push_back(pair.task(side, part.scene, 1));
    }
  }
  const std::vector<StateSeries> after = pair.motions(tasks);
  std::vector<Cause> causes;
  for (std::size_t n = 0; n < injections.size(); ++n) {
    Cause cause;
    cause.at = injections[n];
    const double left = parting.time - h * static_cast<double>(cause.at.sample + 1);
    const auto share = [&](std::size_t k, int body) {
      const std::size_t at = groups[n].first + 2 * k;
      return share_after(after[at], after[at + 1], scene, bounds, body, left);
    };
    const double whole = share(0, cause.at.body), halved = share(1, cause.at.body);
    if (whole <= 0) {
      cause.why = after[groups[n].first].why + after[groups[n].first + 1].why;
      causes.push_back(cause);
      continue;
    }
    if (halved >= 0) cause.at_half_step = halved / whole, cause.is_measured_at_half_step = true;
    for (std::size_t k = 0; k < groups[n].parts.size(); ++k) {
      const Ablation& part = groups[n].parts[k];
      const double rest = share(2 + k, part.transmits ? kWorld : cause.at.body);
      if (rest >= 0) cause.evidence.push_back({part.what, part.detail, 1 - rest / whole, part.rank, part.is_general});
    }
    const BodyState state = motion_a.body(cause.at.sample, static_cast<std::size_t>(cause.at.body));
    cause.roundings = whole / share_of_rounding(state, bounds, left, unit_roundoff(pair));
    cause.is_rounding = cause.roundings < kFewRoundings;
    name_cause(cause);
    causes.push_back(cause);
  }
  return causes;
}

}  // namespace rigor::inline analysis
