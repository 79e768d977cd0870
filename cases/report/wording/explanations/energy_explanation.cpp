#include "cases/report/wording/explanations/energy_explanation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>

#include "cases/analysis/energy_diagnosis.h"
#include "cases/report/wording/cell_claim.h"
#include "cases/report/wording/wording.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline report {
namespace {

class EnergyReasons {
 public:
  EnergyReasons(const Results& results, const CaseResult& result)
      : results_(results), result_(result), dt_(coarsest_dt(result)) {}

  std::vector<Message> messages() {
    if (falls_freely()) explain_fall();
    explain_sampling();
    explain_gyroscopic_term();
    return std::move(messages_);
  }

 private:
  template <typename F>
  void for_headline_cells(const F& f) const {
    for (const Cell& cell : result_.cells) {
      if (cell.dt == dt_ && !cell.metrics.empty()) f(cell, method_of_run(cell.run));
    }
  }

  const MethodInfo& method_of_run(std::size_t run) const {
    for (const EngineInfo& engine : results_.engines) {
      if (engine.name == results_.runs[run].engine) return method_of(engine, results_.runs[run].settings);
    }
    throw std::logic_error("a run of an engine that is not in the table");
  }

  const std::string& name_of(const Cell& cell) const { return results_.runs[cell.run].text; }
  Claim of_cell(const Cell& cell, const std::string& quantity, double value) const {
    return claim_of_cell(results_, result_, cell, quantity, value);
  }

  // Nothing can hold a body, so that each falls from t = 0 on.
  bool falls_freely() const {
    const Scene& scene = result_.definition.scene;
    return scene.springs.empty() && scene.joints.empty() && !anything_can_touch(scene);
  }

  // In free fall a first-order step that takes the new velocity falls g/2 dt t too far. One that takes the old velocity
  // falls as much too short.
  void explain_fall() {
    constexpr double kAlike = 0.01;
    const double missed = 0.5 * result_.definition.scene.gravity.norm() * dt_.seconds;  // m after 1 s
    if (missed == 0 || result_.definition.duration < 1) return;
    Claims claims;
    std::vector<std::string> names;
    for_headline_cells([&](const Cell& cell, const MethodInfo& method) {
      const auto found = cell.metrics.find("position_error");
      if (method.order != 1 || found == cell.metrics.end() || !found->second.not_applicable.empty()) return;
      const double error = found->second.first_second;
      if (!(std::abs(error - missed) < kAlike * missed)) return;
      names.push_back(name_of(cell));
      Claim claim = of_cell(cell, "first second of position_error", error);
      claim.relation = Relation::equal, claim.bound = missed;
      claims.state(claim);
    });
    if (names.empty()) return;
    Claim of_fall = claim_of_scene(result_, "missed fall", missed);
    of_fall.dt = dt_.text;
    messages_.push_back(
        {"fall",
         fmt::format("Why: a first-order step uses one velocity for the whole step. After 1 s at dt = {} "
                     "s a fall is off by g dt t/2 = {}: {}.",
                     dt_.text, claims.quantity(of_fall, "m"), fmt::join(names, ", ")),
         "", claims.take()});
  }

  void explain_sampling() {
    constexpr double kNotable = 1e-3, kMostly = 3;
    Claims claims;
    std::string list;
    for_headline_cells([&](const Cell& cell, const MethodInfo& method) {
      const double raw = std::abs(signed_value(cell.metrics, "energy_drift")),
                   synchronised = std::abs(signed_value(cell.metrics, "energy_drift_synchronised"));
      if (method.leapfrog_stagger == 0 || cell.stability.verdict == Verdict::blown_up) return;
      if (!(raw > kMostly * synchronised) || !(raw > kNotable)) return;
      Claim above = of_cell(cell, "energy_drift", raw);
      above.relation = Relation::above, above.bound = kMostly * synchronised;
      list +=
          fmt::format("{}{} {} as read, {} at one instant", list.empty() ? "" : "; ", name_of(cell),
                      claims.percent(above), claims.percent(of_cell(cell, "energy_drift_synchronised", synchronised)));
    });
    if (list.empty()) return;
    messages_.push_back({"sampling",
                         fmt::format("The raw energy drift is mostly sampling: these methods store velocities that "
                                     "belong half a step before or after the positions. Drift: {}.",
                                     list),
                         "", claims.take()});
  }

  // The engine and its twin gain or lose the same energy. The twin keeps it once its gyroscopic term is off.
  void explain_gyroscopic_term() {
    constexpr double kNotable = 0.01, kAlike = 1e-3, kGone = 0.1;
    for_headline_cells([&](const Cell& cell, const MethodInfo&) {
      const double drift = signed_value(cell.metrics, "energy_drift"),
                   scheme = signed_value(cell.scheme.metrics, "energy_drift"),
                   without = std::abs(signed_value(cell.scheme.without_gyroscopic_term, "energy_drift"));
      const bool is_it = std::abs(drift) > kNotable && std::abs(drift - scheme) < kAlike * std::abs(drift) &&
                         without < kGone * std::abs(drift);
      if (is_it) tell_gyroscopic_term(cell, drift, without);
    });
  }

  void tell_gyroscopic_term(const Cell& cell, double drift, double without) {
    const double momentum = std::abs(signed_value(cell.scheme.without_gyroscopic_term, "angular_momentum_drift"));
    Claims claims;
    Claim of_drift = of_cell(cell, "signed energy_drift", drift);
    Claim of_rest = of_cell(cell, "scheme's energy_drift without gyroscopic term", without);
    of_rest.relation = Relation::below, of_rest.bound = std::abs(drift);
    std::string text = fmt::format(
        "Why: the gyroscopic term changes the energy of {} by {}. The scheme alone, repeated by the core, does the "
        "same. "
        "Without that term it keeps the energy to {}",
        name_of(cell), claims.percent(of_drift), claims.percent(of_rest));
    claims.state(of_cell(cell, "scheme's energy_drift", signed_value(cell.scheme.metrics, "energy_drift")));
    if (std::isfinite(momentum))
      text += fmt::format(
          ", but its angular momentum drifts by {}",
          claims.quantity(of_cell(cell, "scheme's angular_momentum_drift without gyroscopic term", momentum),
                          "kg m²/s"));
    messages_.push_back({"gyroscopic term", text + ".", "", claims.take()});
  }

  const Results& results_;
  const CaseResult& result_;
  StepSize dt_;
  std::vector<Message> messages_;
};

}  // namespace

std::vector<Message> energy_explanations(const Results& results, const CaseResult& result) {
  return EnergyReasons(results, result).messages();
}

}  // namespace rigor::inline report
