#include "cases/analysis/divergence/divergence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "cases/runner/process_pool.h"
#include "cases/truth/provenance.h"
#include "cases/truth/recorded/recorded_motion.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/engine/engine_failure.h"

namespace rigor::inline analysis {
namespace {

using Side = RunPair::Side;

// What the work sends from a child process; or why it sent nothing.
struct FromChild {
  std::string text, why;
};
FromChild from_child(double limit, const std::function<std::string()>& work) {
  FromChild answer;
  const auto on_message = [&](std::size_t, const std::string& message) { answer.text = message; };
  const auto on_end = [&](std::size_t, const JobEnd& end) {
    if (end.how == Ending::refused) answer.why = end.text;
    if (end.how != Ending::finished && end.how != Ending::refused) answer.why = sentence_of(end, limit);
  };
  run_jobs({{[&](const Channel& channel) { channel.send(work()); }, limit}}, 1, on_message, on_end);
  return answer;
}

void refuse_unsupported(const EngineTable& engines, const DivergingRun& run, const Scene& scene) {
  const std::string why = why_unsupported(engines.info_of(run.name.engine), run.name.settings, scene, run.dt.seconds);
  if (!why.empty()) throw InputError(fmt::format("{}: unsupported: {}", run.name.text, why));
}

SettingsInForce settings_in_force(const EngineTable& engines, const DivergingRun& run, const Scene& scene,
                                  double limit) {
  const FromChild answer = from_child(limit, [&] {
    Json pairs = Json::array();
    try {
      const auto world = engines.find(run.name.engine).load(scene, run.name.settings);
      world->step(run.dt.seconds);  // some worlds report settings that depend on the run
      for (const auto& [key, value] : world->settings_in_force()) pairs.push_back({key, value});
    } catch (const EngineFailure& failure) {
      if (failure.kind() != FailureKind::unsupported) throw;
      throw InputError(fmt::format("{}: unsupported: {}", run.name.text, failure.what()));
    }
    engines.rest();
    return pairs.dump(-1, ' ', false, Json::error_handler_t::replace);
  });
  if (!answer.why.empty()) throw InputError(fmt::format("{}: {}", run.name.text, answer.why));
  SettingsInForce settings;
  for (const Json& pair : parse_json(answer.text))
    settings.emplace_back(pair.at(0).get<std::string>(), pair.at(1).get<std::string>());
  return settings;
}

// The state of a body, as a message.
std::string packed(const BodyState& state, double error) {
  const double numbers[] = {state.position.x(),         state.position.y(),
                            state.position.z(),         state.orientation.w(),
                            state.orientation.x(),      state.orientation.y(),
                            state.orientation.z(),      state.velocity.x(),
                            state.velocity.y(),         state.velocity.z(),
                            state.angular_velocity.x(), state.angular_velocity.y(),
                            state.angular_velocity.z(), error};
  return {reinterpret_cast<const char*>(numbers), sizeof numbers};
}

BodyState unpacked(const std::string& text, double& error) {
  double n[14];
  std::memcpy(n, text.data(), sizeof n);
  error = n[13];
  return {Vec3(n[0], n[1], n[2]), Quat(n[3], n[4], n[5], n[6]), Vec3(n[7], n[8], n[9]), Vec3(n[10], n[11], n[12])};
}

double distance(const BodyState& found, const BodyState& truth, const std::string& unit) {
  const BodyGap gap = gap_between(truth, found);
  if (unit == "m") return gap.position.norm();
  if (unit == "rad") return gap.turn.norm();
  return unit == "m/s" ? gap.velocity.norm() : gap.angular_velocity.norm();
}

DivergenceTruth judged_by_truth(const Case& definition, const Divergence& found, const MotionView& in_a,
                                const MotionView& in_b, double limit) {
  const Parting& parting = *found.parting;
  DivergenceTruth truth;
  if (definition.truth == "none") {
    truth.why = "the case has no truth";
    return truth;
  }
  const auto body = static_cast<std::size_t>(parting.body);
  const FromChild answer = from_child(limit, [&] {
    const auto made = truth_of(definition, std::max(parting.time, found.steps.seconds));
    BodyTable table(definition.scene.bodies.size());
    made->at(parting.time, table.columns());
    return packed(std::as_const(table).columns().body(body), made->error(parting.time));
  });
  truth.why = answer.why;
  if (!truth.why.empty()) return truth;
  const BodyState state = unpacked(answer.text, truth.error);
  truth.a = distance(in_a.body(parting.sample, body), state, parting.unit);
  truth.b = distance(in_b.body(parting.sample, body), state, parting.unit);
  truth.is_made_like_a = is_made_by(definition.truth, found.a.name, definition.scene);
  truth.is_made_like_b = is_made_by(definition.truth, found.b.name, definition.scene);
  // In the parting's unit if that is a pose; a rate is vouched for by the pose alone.
  if (truth.error > 0.5 * parting.gap && (parting.unit == "m" || parting.unit == "rad"))
    truth.why = fmt::format("the truth is known only to {:.2g} {} then", truth.error, parting.unit);
  return truth;
}

// Repeats of both runs, sample by sample.
std::vector<double> spread_of(const std::vector<StateSeries>& runs, const Scene& scene, Divergence& found) {
  std::vector<double> spread;
  for (const std::size_t first : {0, 2}) {
    double& most = first == 0 ? found.spread_a : found.spread_b;
    if (runs[first].states == runs[first + 1].states) continue;
    const MotionView one(runs[first], scene.bodies.size()), two(runs[first + 1], scene.bodies.size());
    for (std::size_t n = 0; n < std::min(one.samples(), two.samples()); ++n) {
      double share = 0;
      for (std::size_t i = 0; i < one.bodies(); ++i)
        share = std::max(share, share_of(gap_between(one.body(n, i), two.body(n, i)), found.bounds));
      if (spread.size() <= n) spread.resize(n + 1, 0);
      most = std::max(most, share), spread[n] = std::max(spread[n], share);
    }
  }
  return spread;
}

}  // namespace

std::optional<Side> DivergenceTruth::nearer() const {
  if (!why.empty() || std::abs(a - b) <= 2 * error) return {};
  return a < b ? Side::a : Side::b;
}

Divergence diverge(const EngineTable& engines, const Case& definition, const DivergingRun& a, const DivergingRun& b,
                   const PartingBounds& bounds, const DivergenceOptions& options) {
  constexpr std::size_t kCauses = 3;
  const Scene& scene = definition.scene;
  for (const DivergingRun* run : {&a, &b}) refuse_unsupported(engines, *run, scene);
  Divergence found;
  found.case_id = definition.id, found.a = a, found.b = b, found.bounds = bounds;
  for (const Body& body : scene.bodies) found.names.push_back(body.name);
  found.steps = common_steps(a.dt, b.dt, definition.duration);
  found.in_a = settings_in_force(engines, a, scene, options.limit);
  found.in_b = settings_in_force(engines, b, scene, options.limit);
  const RunPair pair(engines, a, b, found.steps, options);
  const auto shared = std::make_shared<Scene>(scene);
  const MotionTask of_a = pair.task(Side::a, shared, found.steps.count),
                   of_b = pair.task(Side::b, shared, found.steps.count);
  const std::vector<StateSeries> runs = pair.motions({of_a, of_a, of_b, of_b});
  for (const std::size_t n : {0, 2}) {
    if (!runs[n].why.empty()) throw InputError(fmt::format("{}: {}", (n == 0 ? a : b).name.text, runs[n].why));
  }
  const MotionView in_a(runs[0], scene.bodies.size()), in_b(runs[2], scene.bodies.size());
  const std::size_t samples = std::min(in_a.samples(), in_b.samples());
  found.compared = found.steps.seconds * static_cast<double>(samples - std::min<std::size_t>(samples, 1));
  if (samples <= static_cast<std::size_t>(found.steps.count))
    found.ended = fmt::format("{} blows up at {:.4g} s", (in_a.samples() <= in_b.samples() ? a : b).name.text,
                              found.compared + found.steps.seconds);
  const std::vector<double> spread = spread_of(runs, scene, found);
  found.largest = largest_share(in_a, in_b, scene, bounds, samples);
  found.parting = find_parting(in_a, in_b, scene, bounds, found.steps.seconds, spread);
  found.gap = gap_series(in_a, in_b, scene, bounds, found.steps.seconds, found.parting);
  if (!found.parting) return found;
  found.truth = judged_by_truth(definition, found, in_a, in_b, options.limit);
  if (found.parting->sample == 0) return found;  // the engines load different states
  found.injections = find_injections(pair, scene, in_a, in_b, bounds, *found.parting);
  found.causes = find_causes(pair, scene, in_a, bounds, *found.parting, largest_injections(found.injections, kCauses));
  found.swaps = search_swaps(pair, scene, definition.duration, found.in_a, found.in_b, bounds, *found.parting, options);
  return found;
}

}  // namespace rigor::inline analysis
