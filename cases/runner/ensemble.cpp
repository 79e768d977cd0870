#include "cases/runner/ensemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "core/engine/engine.h"
#include "core/engine/simulation.h"

namespace rigor::inline runner {
namespace {

constexpr const char* kReference = "core:velocity-verlet";  // with the contact that the core takes by itself
constexpr double kDiffers = 0.01;                           // a p-value below
// Each ensemble its own starts: of the runs judged, of the reference, and of the finer one.
constexpr std::uint64_t kOfRun = 1, kOfReference = 1'000'001, kOfFiner = 2'000'001;

double finest(const Case& definition) {
  const auto least = std::min_element(definition.dt.begin(), definition.dt.end(),
                                      [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
  return least->seconds;
}

}  // namespace

Scene jittered(const Scene& scene, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  // Its own numbers, so that they are the same with every library.
  const auto number = [&] { return kJitter * (static_cast<double>(random() >> 11) * 0x1p-52 - 1); };
  Scene out = scene;
  for (Body& body : out.bodies) {
    if (body.fixed) continue;
    for (Vec3* start : {&body.position, &body.velocity}) {
      for (int axis = 0; axis < 3; ++axis) (*start)[axis] += number();
    }
  }
  return out;
}

std::optional<Points> outcomes_of(const Engine& engine, const Settings& settings, const Case& definition, double dt,
                                  std::uint64_t first_seed, std::string& flaw) {
  Points outcomes;
  const long steps = steps_in(definition.duration, dt);
  Snapshot end;
  for (int k = 0; k < definition.ensemble; ++k) {
    const auto world = engine.load(jittered(definition.scene, first_seed + static_cast<std::uint64_t>(k)), settings);
    expect_steps(*world, dt, steps, steps);
    for (long n = 0; n < steps; ++n) {
      world->step(dt);
      if (flaw.empty()) flaw = world->solver_warning();
    }
    world->read(end);
    std::vector<double> point;
    for (std::size_t i = 0; i < end.bodies().size(); ++i) {
      if (definition.scene.bodies[i].fixed) continue;
      for (int axis = 0; axis < 3; ++axis) point.push_back(end.bodies().position(i)[axis]);
    }
    const bool is_finite = std::all_of(point.begin(), point.end(), [](double x) { return std::isfinite(x); });
    if (flaw.empty() && !is_finite) flaw = fmt::format("start {} blew up", k + 1);
    if (!flaw.empty()) return {};
    outcomes.push_back(std::move(point));
  }
  return outcomes;
}

EnsembleReference::EnsembleReference(const EngineTable& engines, const Case& definition) {
  const RunName run = parse_run_name(kReference, infos_of(engines));
  const Engine& engine = find_engine(engines, run.engine);
  const auto ensemble = [&](double share, std::uint64_t seed) {
    return outcomes_of(engine, run.settings, definition, share * finest(definition), seed, flaw_);
  };
  flaw_ = why_unsupported(engines.info_of(run.engine), run.settings, definition.scene, finest(definition));
  if (flaw_.empty()) outcomes_ = ensemble(1, kOfReference);
  std::optional<Points> finer;
  if (outcomes_) finer = ensemble(0.5, kOfFiner);
  if (!flaw_.empty()) {
    flaw_ = "no reference: " + flaw_;
    return;
  }
  const EnergyTest test = energy_test(*outcomes_, *finer, kPermutations, kOfReference);
  if (test.p_value < kDiffers)
    flaw_ =
        fmt::format("no reference: its own outcomes differ between its step and half of that (H = {:.2g}, p = {:.2g})",
                    test.coefficient, test.p_value);
}

Ensembles EnsembleReference::compare(const EngineTable& engines, const RunName& run, const Case& definition,
                                     double dt) const {
  Ensembles found;
  found.flaw = flaw_;
  if (!flaw_.empty()) return found;
  const auto outcomes = outcomes_of(find_engine(engines, run.engine), run.settings, definition, dt, kOfRun, found.flaw);
  if (outcomes) found.test = energy_test(*outcomes, *outcomes_, kPermutations, kOfRun);
  return found;
}

std::string cost_of_ensemble(const Case& definition, std::size_t cells) {
  if (definition.ensemble == 0) return "";
  return fmt::format("{}: an ensemble of {} starts: {} runs of a reference, and {} in each of {} cells", definition.id,
                     definition.ensemble, 2 * definition.ensemble, definition.ensemble, cells);
}

}  // namespace rigor::inline runner
