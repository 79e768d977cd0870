#include "cases/report/wording/explanations/blow_up_explanation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "cases/analysis/metric_over_steps.h"
#include "cases/analysis/small_motions/oscillator_growth.h"
#include "cases/analysis/small_motions/small_motions.h"
#include "cases/report/wording/cell_claim.h"
#include "cases/report/wording/wording.h"

namespace rigor::inline report {
namespace {

constexpr const char* kMode = "mode";  // Claim::part of the stiffest mode

// A linear oscillator that a message names as the reason.
struct BlowUpSuspect {
  std::string part;  // kMode, or an element's name
  ForceElement::Kind kind = ForceElement::Kind::spring;
  Oscillator oscillator;
};

struct BlownUpRun {
  const Cell* cell;
  std::optional<double> growth;  // of the suspect that explains it, in one step
};

double semi_implicit_growth(const Oscillator& oscillator, double dt) {
  // z² - (2 - g - k) z + (1 - g) = 0
  const double g = oscillator.rate * dt, k = std::pow(oscillator.frequency * dt, 2);
  const double half = 0.5 * (2 - g - k), discriminant = half * half - (1 - g);
  const double radius = discriminant < 0 ? std::sqrt(std::abs(1 - g)) : std::abs(half) + std::sqrt(discriminant);
  return radius * radius;
}

std::string unit_of_damping(ForceElement::Kind kind) {
  return kind == ForceElement::Kind::hinge ? "N m s/rad" : "N s/m";
}
std::string unit_of_inertia(ForceElement::Kind kind) { return kind == ForceElement::Kind::hinge ? "kg m²" : "kg"; }

class BlowUps {
 public:
  BlowUps(const Results& results, const CaseResult& result)
      : results_(results), result_(result), dt_(coarsest_dt(result)) {}

  std::vector<Message> messages() {
    std::vector<const Cell*> blown;
    for (const Cell& cell : result_.cells) {
      const bool is_it = cell.dt == dt_ && !cell.metrics.empty() && cell.stability.verdict == Verdict::blown_up;
      if (is_it) blown.push_back(&cell);
    }
    if (blown.empty()) return {};
    motions_ = SmallMotions::of(result_.definition.scene);
    std::vector<BlownUpRun> by_damper, by_servo, by_spring;
    std::vector<const Cell*> by_orientation, others;
    const std::optional<BlowUpSuspect> damper = damper_suspect(), servo = servo_suspect(), spring = spring_suspect();
    for (const Cell* cell : blown) {
      const auto damped = damper ? growth_that_explains(*damper, *cell) : std::nullopt;
      const auto driven = servo && !damped ? growth_that_explains(*servo, *cell) : std::nullopt;
      const auto sprung = spring && !damped && !driven ? growth_that_explains(*spring, *cell) : std::nullopt;
      if (damped)
        by_damper.push_back({cell, damped});
      else if (driven)
        by_servo.push_back({cell, driven});
      else if (sprung)
        by_spring.push_back({cell, sprung});
      else
        (loses_orthonormality(*cell) ? by_orientation : others).push_back(cell);
    }
    if (!by_damper.empty()) tell_damper(*damper, by_damper);
    if (!by_servo.empty()) tell_servo(*servo, by_servo);
    if (!by_spring.empty()) tell_spring(*spring, by_spring);
    if (!by_orientation.empty()) tell_orientation(by_orientation);
    if (!others.empty() && motions_) tell_unexplained(others);
    return std::move(messages_);
  }

 private:
  // The element with the highest damping rate, where its damper limits the step rather than its spring.
  std::optional<BlowUpSuspect> damper_suspect() const {
    const ForceElement* most = motions_ ? motions_->most_damped() : nullptr;
    if (!most) return {};
    const Oscillator alone = SmallMotions::alone(*most);
    const double g = alone.rate * dt_.seconds, k = std::pow(alone.frequency * dt_.seconds, 2);
    if (!(g > 2) || 2 * g < k) return {};
    return BlowUpSuspect{most->name, most->kind, alone};
  }

  std::optional<BlowUpSuspect> servo_suspect() const {
    const ForceElement* most = motions_ ? motions_->stiffest_servo() : nullptr;
    if (!most || largest_semi_implicit_step(SmallMotions::alone(*most)) > dt_.seconds) return {};
    return BlowUpSuspect{most->name, most->kind, SmallMotions::alone(*most)};
  }

  std::optional<BlowUpSuspect> spring_suspect() const {
    if (!motions_ || !(motions_->stiffest().frequency > 0)) return {};
    return BlowUpSuspect{kMode, motions_->stiffest_element().kind, motions_->stiffest()};
  }

  // The run of the core that is, or repeats, the cell's run.
  std::string core_run(const Cell& cell) const {
    return is_in_house(results_, cell.run) ? results_.runs[cell.run].text : cell.scheme.twin;
  }

  double stagger_of(const Cell& cell) const {
    const RunName& run = results_.runs[cell.run];
    for (const EngineInfo& engine : results_.engines) {
      if (engine.name == run.engine) return method_of(engine, run.settings).leapfrog_stagger;
    }
    return 0;
  }

  // Linearly implicit Euler has the same stagger, and no limit of its step on springs.
  bool is_semi_implicit(const Cell& cell) const {
    return stagger_of(cell) > 0 && results_.runs[cell.run].settings.method != "linearly-implicit-euler";
  }

  // Without a twin a scheme is known by its stagger alone, and whether it takes dampers explicitly is not known. It
  // does not if it was found stable at a step at which an explicit one would be unstable.
  std::optional<double> growth_of(const BlowUpSuspect& suspect, const Cell& cell) const {
    constexpr double kPrecision = 1.5;  // of a bound for small motions, beside motions that are not small
    const std::string core = core_run(cell);
    if (!core.empty()) return energy_growth(core, suspect.kind, suspect.oscillator, dt_.seconds);
    const StableStepResult& stable = result_.stable_steps[cell.run];
    const bool is_beyond = stable.status == Status::pass && !stable.step.is_floor &&
                           stable.step.dt > kPrecision * largest_semi_implicit_step(suspect.oscillator);
    if (is_semi_implicit(cell) && !is_beyond) return semi_implicit_growth(suspect.oscillator, dt_.seconds);
    return {};
  }

  // The growth of the oscillator's energy in one step, if it suffices for a blow-up in the time that it took.
  std::optional<double> growth_that_explains(const BlowUpSuspect& suspect, const Cell& cell) const {
    constexpr double kBlownUp = 10;  // times the energy in play, see metrics/stability.h
    const auto growth = growth_of(suspect, cell);
    const double steps = std::max(1.0, cell.stability.time / dt_.seconds);
    if (!growth || !(std::pow(*growth, steps) > kBlownUp)) return {};
    return growth;
  }

  static bool loses_orthonormality(const Cell& cell) {
    constexpr double kLost = 0.1;  // a quaternion that is normalised keeps 1e-15
    const auto found = cell.metrics.find("orthonormality_error");
    return found != cell.metrics.end() && found->second.not_applicable.empty() && found->second.value > kLost;
  }

  const std::string& name_of(const Cell& cell) const { return results_.runs[cell.run].text; }
  Claim of_cell(const Cell& cell, const std::string& quantity, double value) const {
    return claim_of_cell(results_, result_, cell, quantity, value);
  }
  Claim of_scene(const std::string& quantity, double value, const std::string& part) const {
    return claim_of_scene(result_, quantity, value, part);
  }
  Claim at_dt(const std::string& quantity, double value, const std::string& part) const {
    Claim claim = of_scene(quantity, value, part);
    claim.dt = dt_.text;
    return claim;
  }

  // "5.3 (core:explicit-euler), 25 (bullet, dart)": runs with the same growth share its number.
  std::string growths(Claims& claims, const BlowUpSuspect& suspect, const std::vector<BlownUpRun>& runs) const {
    std::vector<std::pair<std::string, std::string>> said;  // the number, and whose it is
    for (const BlownUpRun& run : runs) {
      Claim claim = of_cell(*run.cell, "energy growth", *run.growth);
      claim.part = suspect.part, claim.relation = Relation::above, claim.bound = 1;
      const std::string number = claims.printed(claim, three_digits(*run.growth));
      const auto same = std::find_if(said.begin(), said.end(), [&](const auto& one) { return one.first == number; });
      if (same == said.end())
        said.emplace_back(number, name_of(*run.cell));
      else
        same->second += ", " + name_of(*run.cell);
    }
    std::string text;
    for (const auto& [number, names] : said) text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", number, names);
    return text;
  }

  void tell_damper(const BlowUpSuspect& damper, const std::vector<BlownUpRun>& runs) {
    const auto& elements = motions_->elements();
    const ForceElement& element = element_named(damper.part);
    const double ratio = damper.oscillator.rate * dt_.seconds;
    Claims claims;
    Claim exceeds = at_dt("damping times dt over inertia", ratio, damper.part);
    exceeds.relation = Relation::above, exceeds.bound = 2;
    const bool is_hinge = damper.kind == ForceElement::Kind::hinge;
    std::string text = fmt::format(
        "Why: {} has a damper of {} on {} of {}. At dt = {} s this makes c dt/{} = {}; a semi-implicit step needs less "
        "than 2.",
        damper.part, claims.quantity(of_scene("damping", element.damping, damper.part), unit_of_damping(damper.kind)),
        is_hinge ? "an inertia" : "a mass",
        claims.quantity(of_scene("inertia", element.inertia, damper.part), unit_of_inertia(damper.kind)), dt_.text,
        is_hinge ? "I" : "m", claims.quantity(exceeds, ""));
    text +=
        fmt::format(" In one step the energy of this motion grows by a factor of {}.", growths(claims, damper, runs));
    const auto others =
        std::count_if(elements.begin(), elements.end(),
                      [&](const ForceElement& one) { return !one.is_servo && one.damping_rate() * dt_.seconds > 2; }) -
        1;
    if (others > 0)
      text += fmt::format(" {} other damper{} exceed{} that.",
                          claims.count(at_dt("other overdamped elements", static_cast<double>(others), damper.part)),
                          others == 1 ? "" : "s", others == 1 ? "s" : "");
    text += fmt::format(
        " Remedy: dt below {}, or less damping{}.",
        claims.quantity(of_scene("semi-implicit step", largest_semi_implicit_step(damper.oscillator), damper.part),
                        "s"),
        stable_runs(claims));
    messages_.push_back({"damper", text, "", claims.take()});
  }

  const ForceElement& element_named(const std::string& name) const {
    const auto& elements = motions_->elements();
    return *std::find_if(elements.begin(), elements.end(), [&](const ForceElement& one) { return one.name == name; });
  }

  void tell_servo(const BlowUpSuspect& servo, const std::vector<BlownUpRun>& runs) {
    const ForceElement& element = element_named(servo.part);
    const bool is_hinge = servo.kind == ForceElement::Kind::hinge;
    const char* inertia = is_hinge ? "I" : "m";
    Claims claims;
    Claim exceeds = at_dt(
        "servo's step", std::pow(servo.oscillator.frequency * dt_.seconds, 2) + 2 * servo.oscillator.rate * dt_.seconds,
        servo.part);
    exceeds.relation = Relation::above, exceeds.bound = 4;
    std::string text = fmt::format(
        "Why: {} has kp = {} and kd = {} on {} of {}. Its effort is that of a step's start, which needs kp dt²/{} + 2 "
        "kd "
        "dt/{} below 4. At dt = {} s this is {}.",
        servo.part,
        claims.quantity(of_scene("servo's kp", element.stiffness, servo.part), is_hinge ? "N m/rad" : "N/m"),
        claims.quantity(of_scene("damping", element.damping, servo.part), unit_of_damping(servo.kind)),
        is_hinge ? "an inertia" : "a mass",
        claims.quantity(of_scene("inertia", element.inertia, servo.part), unit_of_inertia(servo.kind)), inertia,
        inertia, dt_.text, claims.quantity(exceeds, ""));
    text +=
        fmt::format(" In one step the energy of this motion grows by a factor of {}.", growths(claims, servo, runs));
    text += fmt::format(
        " Remedy: dt below {}, or smaller gains{}.",
        claims.quantity(of_scene("semi-implicit step", largest_semi_implicit_step(servo.oscillator), servo.part), "s"),
        stable_runs(claims));
    messages_.push_back({"servo", text, "", claims.take()});
  }

  // ", or an engine that is stable here: mujoco, simbody"
  std::string stable_runs(Claims& claims) const {
    constexpr std::size_t kMost = 4;
    std::vector<std::string> names;
    for (const Cell& cell : result_.cells) {
      const bool is_stable = cell.dt == dt_ && !cell.metrics.empty() && cell.status == Status::pass &&
                             cell.stability.verdict == Verdict::stable;
      if (!is_stable) continue;
      names.push_back(name_of(cell));
      if (names.size() <= kMost) claims.state(of_cell(cell, "count of stable", 1));
    }
    if (names.empty()) return "";
    names.resize(std::min(names.size(), kMost));
    return fmt::format(", or a run that is stable here: {}", fmt::join(names, ", "));
  }

  // The motion may belong to both together.
  const char* springs() const { return motions_->stiffest_servo() ? "spring and servo" : "spring"; }

  void tell_spring(const BlowUpSuspect& spring, const std::vector<BlownUpRun>& runs) {
    Claims claims;
    const double frequency = spring.oscillator.frequency;
    std::string text =
        fmt::format("Why: the stiffest {} mode has ω = {}, so ω dt = {} at dt = {} s.", springs(),
                    claims.quantity(of_scene("spring frequency", frequency, kMode), "rad/s"),
                    claims.quantity(at_dt("spring frequency times dt", frequency * dt_.seconds, kMode), ""), dt_.text);
    text += fmt::format(" In one step its energy grows by a factor of {}.", growths(claims, spring, runs));
    const bool has_semi_implicit =
        std::any_of(runs.begin(), runs.end(), [&](const BlownUpRun& run) { return is_semi_implicit(*run.cell); });
    if (has_semi_implicit)
      text += fmt::format(
          " A semi-implicit step needs dt below about {}.",
          claims.quantity(of_scene("semi-implicit step", largest_semi_implicit_step(spring.oscillator), kMode), "s"));
    const bool is_explicit = std::any_of(runs.begin(), runs.end(), [&](const BlownUpRun& run) {
      return results_.runs[run.cell->run].settings.method == "explicit-euler" && is_in_house(results_, run.cell->run);
    });
    if (is_explicit && spring.oscillator.rate == 0)
      text += " With explicit Euler a smaller dt slows this growth but never ends it.";
    messages_.push_back({"spring", text, "", claims.take()});
  }

  void tell_orientation(const std::vector<const Cell*>& cells) {
    Claims claims;
    std::string list;
    bool is_additive = true;
    for (const Cell* cell : cells) {
      const MetricValue& error = cell->metrics.at("orthonormality_error");
      const bool has_second = cell->stability.time > 1 && std::isfinite(error.first_second);
      Claim claim = of_cell(*cell, has_second ? "first second of orthonormality_error" : "orthonormality_error",
                            has_second ? error.first_second : error.value);
      list += fmt::format("{}{} {}{}", list.empty() ? "" : ", ", name_of(*cell), claims.quantity(claim, ""),
                          has_second ? " in the first second" : "");
      is_additive &= setting_of(*cell, "orientation") == "matrix-additive";
    }
    std::string text =
        fmt::format("Why: the orientation is no rotation any more. |RᵀR − I|, zero for a rotation, reaches: {}.", list);
    if (is_additive)
      text += " The update \"matrix-additive\" never restores the matrix. Remedy: orientation=matrix-rodrigues.";
    messages_.push_back({"orientation", text, "", claims.take()});
  }

  void tell_unexplained(const std::vector<const Cell*>& cells) {
    Claims claims;
    std::vector<std::string> names;
    for (const Cell* cell : cells) {
      names.push_back(name_of(*cell));
      claims.state(of_cell(*cell, "count of blown up", 1));
    }
    const double frequency = motions_->stiffest().frequency;
    std::string text = fmt::format("Not explained: why {} blew up.", fmt::join(names, ", "));
    if (frequency > 0)
      text += fmt::format(" Small swings of the {}s at the start have ω dt = {}, which does not explain it.", springs(),
                          claims.quantity(at_dt("spring frequency times dt", frequency * dt_.seconds, kMode), ""));
    messages_.push_back({"blow-up", text, "", claims.take()});
  }

  const Results& results_;
  const CaseResult& result_;
  StepSize dt_;
  std::optional<SmallMotions> motions_;
  std::vector<Message> messages_;
};

}  // namespace

std::vector<Message> blow_up_explanations(const Results& results, const CaseResult& result) {
  return BlowUps(results, result).messages();
}

}  // namespace rigor::inline report
