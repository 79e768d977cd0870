#include "cases/runner/stable_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "cases/metrics/measures/contact/tunnelling.h"
#include "cases/metrics/measures/energy_series.h"
#include "cases/metrics/stability.h"
#include "core/dynamics/model/energy.h"
#include "core/engine/engine.h"
#include "core/engine/simulation.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline runner {
namespace {

constexpr double kLargestStep = 0.5, kSmallestStep = 1e-5;  // s, tried
constexpr double kStepPrecision = 1.01;                     // 1 %
constexpr double kCoarsePrecision = 1.05;                   // where steps are tried 20 % apart
constexpr double kMostWork = 10e6;                          // steps of one free body: some three seconds
constexpr double kMostJointedWork = 0.4e6;                  // likewise in jointed scenes, which are many and dear
// s: a method that divides its own steps counts as taking one of them in each; it takes any number.
constexpr double kInnerStep = 1e-3;

// The ratio from one step tried to the next. Springs resonate with a step in narrow bands of it; bodies that touch and
// have none do not: 333 of 334 searches of the suite found the same at 20 % as at 3 %. Joints without springs are taken
// likewise.
double sweep_of(const Scene& scene) {
  const bool is_sprung = !scene.springs.empty() || std::any_of(scene.joints.begin(), scene.joints.end(),
                                                               [](const Joint& joint) { return joint.stiffness != 0; });
  return !is_sprung && (anything_can_touch(scene) || !scene.joints.empty()) ? 1.2 : 1.03;
}

// What a step takes, in steps of one free body: a joint is solved together with its neighbours, and where it meets a
// limit the step is tried some ten times, to find when. Where joints close loops, most engines solve all of them in one
// dense system: the 600 rows of 121 hinges take 30 ms, a hundred thousand steps of a body.
double work_of_step(const Scene& scene) {
  constexpr double kOfJoint = 30, kOfLimit = 300, kOfDenseSystem = 0.06;
  const auto joints = static_cast<double>(scene.joints.size()), bodies = static_cast<double>(scene.bodies.size());
  double work = bodies + static_cast<double>(scene.springs.size());
  if (joints > bodies) work += kOfDenseSystem * joints * joints * joints;
  for (const Joint& joint : scene.joints) work += joint.has_limits() ? kOfLimit : kOfJoint;
  return work;
}

bool divides_its_steps(const EngineInfo& engine, const Settings& settings) {
  return std::any_of(engine.methods.begin(), engine.methods.end(),
                     [&](const MethodInfo& method) { return method.name == settings.method && method.adaptive; });
}

double precision_of(const Scene& scene) {
  return sweep_of(scene) > kCoarsePrecision ? kCoarsePrecision : kStepPrecision;
}

double most_work(const Scene& scene) { return scene.joints.empty() ? kMostWork : kMostJointedWork; }

class Search {
 public:
  Search(const Engine& engine, const Settings& settings, const Scene& scene, double horizon, double energy_in_play)
      : engine_(engine),
        settings_(settings),
        scene_(scene),
        horizon_(horizon),
        energy_in_play_(energy_in_play),
        steps_left_(most_work(scene) / work_of_step(scene)),
        divides_steps_(divides_its_steps(engine.info(), settings)) {}

  StableStep result() {
    double longest = kLargestStep;
    if (divides_steps_ && !scene_.joints.empty()) {
      if (survives(longest) == true)
        return {longest, true, false, fmt::format("its method divides each step: {:g} s alone was tried", longest)};
      longest *= 0.5;
    }
    if (!bracket(longest)) return found_;
    if (divides_steps_ && !scene_.joints.empty()) {
      found_ = {good_, false, false,
                fmt::format("its method divides each step: halves of {:g} s alone were tried", kLargestStep)};
      return found_;
    }
    if (!bisect()) return found_;
    if (steps_of_sweep() > steps_left_ / 2) {
      found_.cut = fmt::format("by bisection from {:.3g} s up: a sweep would take too many steps", doubled_);
    } else if (!sweep()) {
      return found_;
    }
    found_.dt = good_, found_.is_cap = good_ == kLargestStep;
    return found_;
  }

 private:
  // From dt down by halves, for an unstable run ends early, until a step and its double are stable. False if the search
  // ends here.
  bool bracket(double dt) {
    int stable_in_a_row = 0;
    for (; dt >= kSmallestStep && stable_in_a_row < 2; dt *= 0.5) {
      const auto holds = survives(dt);
      if (!holds && stable_in_a_row == 0) {
        found_ = {2 * dt, false, true, fmt::format("{}: not searched below {:.3g} s", out_of_work(), 2 * dt)};
        return false;
      }
      if (!holds) break;
      stable_in_a_row = *holds ? stable_in_a_row + 1 : 0;
    }
    if (stable_in_a_row == 0) {
      found_ = {kSmallestStep, false, true, ""};
      return false;
    }
    held_ = 2 * dt;  // the last one tried
    good_ = doubled_ = stable_in_a_row == 2 ? 2 * held_ : held_;
    unstable_ = 2 * doubled_;
    return true;
  }

  // Between the largest known to hold and the smallest known not to. False if the search ends here.
  bool bisect() {
    while (good_ < kLargestStep && unstable_ > precision_of(scene_) * good_) {
      const double middle = std::sqrt(unstable_ * good_);
      const auto holds = survives(middle);
      if (!holds) return ended_beyond(good_), false;
      (*holds ? good_ : unstable_) = middle;
    }
    return true;
  }

  // By small steps from the smallest that was tried: the nearest to half of what holds.
  double start_of_sweep() const {
    double dt = held_;
    while (2 * dt * sweep_of(scene_) <= good_) dt *= sweep_of(scene_);
    return dt;
  }

  double steps_of_sweep() const {
    double steps = 0;
    for (double dt = start_of_sweep(); dt < good_; dt *= sweep_of(scene_)) steps += steps_counted(dt) * horizon_ / dt;
    return steps;
  }

  // Up by small steps, from half of what holds to what does: where one does not, the limit is below it. False if the
  // search ends here.
  bool sweep() {
    const double top = good_;
    for (double dt = start_of_sweep(); dt < top; dt *= sweep_of(scene_)) {
      const auto holds = survives(dt);
      if (!holds) return ended_beyond(held_), false;
      if (!*holds) {
        good_ = held_, unstable_ = dt;
        return bisect();
      }
      held_ = dt;
    }
    return true;
  }

  std::string out_of_work() const {
    return fmt::format("the search's {:g} million steps of a body are used up", most_work(scene_) / 1e6);
  }

  const StableStep& ended_beyond(double good) {
    found_ = {good, true, false, fmt::format("{}: not searched beyond {:.3g} s", out_of_work(), good)};
    return found_;
  }

  double steps_counted(double dt) const { return divides_steps_ ? std::max(1.0, dt / kInnerStep) : 1; }

  // None: the work allowed is used up.
  std::optional<bool> survives(double dt) {
    const std::unique_ptr<World> world = engine_.load(scene_, settings_);
    Snapshot now;
    world->read(now);
    const double start = energy(scene_, now.bodies());
    const bool may_lose = contact_may_lose(scene_);
    Tunnelling tunnelling(scene_);
    tunnelling.go_on(now.time, now.bodies(), true);
    const long whole = steps_in(horizon_, dt),
               steps = static_cast<double>(whole) * dt < horizon_ * (1 - 1e-9) ? whole + 1 : whole;
    expect_steps(*world, dt, steps, 1);
    for (long n = 0; n < steps; ++n) {
      if (dt < kLargestStep && (steps_left_ -= steps_counted(dt)) < 0) return {};
      world->step(dt);
      world->read(now);
      if (!world->solver_warning().empty()) return false;
      if (!is_bounded(energy(scene_, now.bodies()) - start, energy_in_play_, may_lose)) return false;
      if (tunnelling.go_on(now.time, now.bodies(), true)) return false;
    }
    return true;
  }

  const Engine& engine_;
  const Settings& settings_;
  const Scene& scene_;
  double horizon_, energy_in_play_;
  double steps_left_;  // but those of the first run, which is to be whole
  bool divides_steps_;
  // s: known to hold; twice the smallest that does, which holds too, or that itself; the best so far; the best that
  // does not.
  double held_ = 0, doubled_ = 0, good_ = 0, unstable_ = 0;
  StableStep found_;
};

}  // namespace

StableStep largest_stable_dt(const Engine& engine, const Settings& settings, const Scene& scene, double horizon,
                             double energy_in_play) {
  return Search(engine, settings, scene, horizon, energy_in_play).result();
}

void hold_to_cells(CaseResult& result) {
  const auto fails = [](const Cell& cell) {
    return cell.status == Status::diverged || cell.status == Status::invalid ||
           cell.stability.verdict == Verdict::blown_up || cell.stability.verdict == Verdict::tunnelled;
  };
  for (std::size_t run = 0; run < result.stable_steps.size(); ++run) {
    StableStepResult& stable = result.stable_steps[run];
    if (stable.status != Status::pass) continue;
    const Cell *worst = nullptr, *held = nullptr;
    for (const Cell& cell : result.cells) {
      if (cell.run == run && fails(cell) && (!worst || cell.dt.seconds < worst->dt.seconds)) worst = &cell;
    }
    const double known = stable.step.dt * (stable.step.is_floor ? 1 - 1e-9 : 1);  // a floor itself does not hold
    if (!worst || known < worst->dt.seconds) continue;
    for (const Cell& cell : result.cells) {
      const bool is_below = cell.run == run && cell.dt.seconds < worst->dt.seconds && !cell.metrics.empty();
      if (is_below && !fails(cell) && (!held || cell.dt.seconds > held->dt.seconds)) held = &cell;
    }
    const std::string why = fmt::format("the case's own run fails at {} s: ", worst->dt.text);
    stable.step = held ? StableStep{held->dt.seconds, true, false,
                                    why + fmt::format("not searched between that and {} s", held->dt.text)}
                       : StableStep{worst->dt.seconds, false, true, why + "not searched below"};
    stable.reason = stable.step.cut;
  }
}

}  // namespace rigor::inline runner
