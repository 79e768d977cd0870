#include "cases/analysis/mistakes/views.h"

#include <algorithm>
#include <cmath>

#include "cases/runner/twin_run.h"
#include "core/scene/contact_laws.h"
#include "core/world.h"

namespace rigor::inline analysis {
namespace {

constexpr long kSamples = 30;

// The smallest distances that count, as shares of the motion's scale: roundings of a hundred steps; the same with
// joints, which are solved to a tolerance; the depth of a resting contact, g dt², beside a metre.
constexpr double kOfRounding = 1e-10, kOfJoints = 1e-8, kOfContacts = 1e-4;

View view_on(View::Kind kind, std::size_t index, const ProbeScene& probe, const RunName& base, std::vector<double> dt) {
  View view{kind, index, base, std::move(dt), 0, 1};
  view.steps = std::max(1L, std::lround(probe.duration / view.dt.front()));
  view.every = std::max(1L, view.steps / kSamples);
  view.can_touch = anything_can_touch(*probe.scene);
  view.tolerance = view.can_touch ? kOfContacts : probe.scene->joints.empty() ? kOfRounding : kOfJoints;
  return view;
}

// Eliminates a and b from x(h) = x + a hᵖ + b hᵖ⁺¹ + ... at h, h/2, h/4. The two finer steps give `coarse`.
Sight extrapolated(const std::vector<double>& one, const std::vector<double>& half, const std::vector<double>& quarter,
                   int order) {
  Sight sight{{}, {}, ""};
  const std::size_t size = std::min({one.size(), half.size(), quarter.size()});
  const double p = std::pow(2.0, order), q = 2 * p;
  for (std::size_t i = 0; i < size; ++i) {
    const double first = (p * half[i] - one[i]) / (p - 1), second = (p * quarter[i] - half[i]) / (p - 1);
    sight.states.push_back((q * second - first) / (q - 1)), sight.coarse.push_back(second);
  }
  return sight;
}

}  // namespace

std::vector<View> views_of(const EngineTable& engines, const RunName& run, const std::vector<ProbeScene>& probes,
                           const RunName* of_points) {
  const RunName accurate = parse_run_name(core_info().name, engines.infos());
  const MethodInfo& method = method_of(engines.info_of(run.engine), run.settings);
  constexpr int kHighOrder = 4;
  std::vector<View> views;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const ProbeScene& probe = probes[i];
    if (!why_unsupported(engines.info_of(run.engine), run.settings, *probe.scene, probe.dt).empty()) continue;
    const auto twin = twin_of(engines, run, *probe.scene);
    if (twin) {
      views.push_back(view_on(View::Kind::twin, i, probe, *twin, {probe.dt}));
    } else if (anything_can_touch(*probe.scene) || method.order >= kHighOrder || method.adaptive) {
      views.push_back(view_on(View::Kind::accurate, i, probe, accurate, {probe.dt}));
    } else {
      views.push_back(view_on(View::Kind::extrapolated, i, probe, accurate, {probe.dt, probe.dt / 2, probe.dt / 4}));
      views.back().order = method.order;
      if (of_points && probe.is_of_points)
        views.push_back(view_on(View::Kind::same_method, i, probe, *of_points, {probe.dt}));
    }
  }
  return views;
}

bool needs_same_method(const std::vector<View>& views) {
  return std::any_of(views.begin(), views.end(), [](const View& v) { return v.kind == View::Kind::extrapolated; });
}

std::vector<MotionTask> tasks_of(const View& view, const ProbeScene& probe, const Engine& engine,
                                 const Settings& settings, std::shared_ptr<const Fault> fault) {
  std::vector<MotionTask> tasks;
  long times = 1;
  for (const double dt : view.dt) {
    tasks.push_back({&engine, settings, probe.scene, fault, dt, view.steps * times, view.every * times});
    times *= 2;
  }
  return tasks;
}

std::vector<MotionTask> nudged_tasks(std::vector<MotionTask> tasks) {
  // Roundings of a hundred steps, far less than the difference that a twin may have.
  constexpr double kNudge = 1e-14;
  const Vec3 way = kNudge * Vec3(1, -1, 1);
  for (MotionTask& task : tasks) {
    Scene scene = *task.scene;
    for (Body& body : scene.bodies) {
      if (body.fixed) continue;
      body.position += (1 + body.position.norm()) * way, body.velocity += (1 + body.velocity.norm()) * way;
      body.angular_velocity += (1 + body.angular_velocity.norm()) * way;
    }
    task.scene = std::make_shared<Scene>(std::move(scene));
  }
  return tasks;
}

Sight seen(const View& view, const std::vector<StateSeries>& motions, std::size_t first) {
  Sight sight{motions[first].states, {}, ""};
  if (view.dt.size() > 1)
    sight = extrapolated(motions[first].states, motions[first + 1].states, motions[first + 2].states, view.order);
  for (std::size_t n = 0; n < view.dt.size(); ++n) {
    if (!motions[first + n].why.empty()) sight = {{}, {}, motions[first + n].why};
  }
  sight.source = Sight::Source::simulated;
  return sight;
}

}  // namespace rigor::inline analysis
