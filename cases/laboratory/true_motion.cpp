#include "cases/laboratory/true_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "cases/metrics/stability.h"
#include "core/base/error.h"
#include "core/engine/simulation.h"
#include "core/scene/contact_laws.h"
#include "core/world.h"

namespace rigor::inline laboratory {
namespace {

// The solvers of truths take minutes for more.
constexpr std::size_t kMostBodies = 12, kMostColliding = 4;

std::size_t count_moving(const Scene& scene, bool colliding) {
  return static_cast<std::size_t>(std::count_if(scene.bodies.begin(), scene.bodies.end(), [&](const Body& body) {
    return !body.fixed && (!colliding || body.collides);
  }));
}

std::vector<std::string> kinds_for(const Case& changed) {
  std::vector<std::string> kinds;
  if (changed.truth != "none" && changed.truth != "recording") kinds.push_back(changed.truth);
  const std::string solver = anything_can_touch(changed.scene) ? "events" : "reference";
  if (changed.truth != solver) kinds.push_back(solver);
  return kinds;
}

std::string why_too_large(const std::string& kind, const Scene& scene) {
  const bool is_events = kind == "events", is_reference = kind == "reference";
  const std::size_t moving = count_moving(scene, is_events), most = is_events ? kMostColliding : kMostBodies;
  if ((!is_events && !is_reference) || moving <= most) return "";
  return fmt::format("the truth '{}' would take too long in a browser: {} bodies move{}; at most {} here", kind, moving,
                     is_events ? " and collide" : "", most);
}

void append(BodyColumns bodies, double error, TruthTable& table) {
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (int c = 0; c < 13; ++c) table.numbers.push_back(bodies.column(c)[i]);
  table.numbers.push_back(error);
}

}  // namespace

void TruthTable::read(std::size_t row, MutableBodyColumns out) const {
  const double* at = numbers.data() + row * columns();
  for (std::size_t i = 0; i < bodies; ++i)
    for (int c = 0; c < 13; ++c) out.column(c)[i] = *at++;
}

TrueMotion true_motion(const Case& changed) {
  std::string why;
  for (const std::string& kind : kinds_for(changed)) {
    std::string fault = why_too_large(kind, changed.scene);
    if (fault.empty()) {
      try {
        if (auto truth = make_truth(kind, changed.scene, changed.duration)) return {std::move(truth), kind, ""};
      } catch (const InputError& error) {
        fault = error.what();
      }
    }
    if (why.empty()) why = fault;  // of the case's own
  }
  return {nullptr, "", why};
}

TruthTable truth_table(const Case& changed, const TrueMotion& motion, double dt) {
  TruthTable table{.dt = dt, .bodies = changed.scene.bodies.size(), .numbers = {}, .kind = motion.kind};
  const EnergyExtremes extremes = energy_extremes(changed.scene, motion.truth.get(), changed.duration);
  table.kinetic = extremes.kinetic, table.change = extremes.change;
  BodyTable bodies(table.bodies);
  for (long n = 0, steps = steps_in(changed.duration, dt); motion.truth && n <= steps; ++n) {
    const double t = static_cast<double>(n) * dt;
    motion.truth->at(t, bodies.columns());
    append(std::as_const(bodies).columns(), motion.truth->error(t), table);
  }
  return table;
}

TruthTable provisional_table(const Case& changed, double dt) {
  TruthTable table{.dt = dt, .bodies = changed.scene.bodies.size(), .numbers = {}, .kind = "core:dormand-prince"};
  table.is_provisional = true;
  const EnergyExtremes extremes = energy_extremes(changed.scene, nullptr, changed.duration);
  table.kinetic = extremes.kinetic, table.change = extremes.change;
  const auto world = load_world(changed.scene, "core:dormand-prince");
  Snapshot now;
  for (long n = 0, steps = steps_in(changed.duration, dt); n <= steps; ++n) {
    if (n > 0) world->step(dt);
    world->read(now);
    append(now.bodies(), std::numeric_limits<double>::quiet_NaN(), table);
  }
  return table;
}

}  // namespace rigor::inline laboratory
