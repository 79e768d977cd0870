#include "adapters/simbody/simbody_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "adapters/simbody/simbody_reactions.h"
#include "adapters/simbody/simbody_system.h"
#include "core/engine/clock.h"
#include "core/engine/engine.h"
#include "core/engine/engine_failure.h"
#include "core/engine/option_values.h"

namespace rigor::inline adapters {
namespace {

using IntegratorPointer = std::unique_ptr<SimTK::Integrator>;

template <typename Kind>
IntegratorPointer make_of(const SimTK::System& system) {
  return std::make_unique<Kind>(system);
}
template <>
IntegratorPointer make_of<SimTK::SemiExplicitEulerIntegrator>(const SimTK::System& system) {
  return std::make_unique<SimTK::SemiExplicitEulerIntegrator>(system, 1.0);  // its step is set anew
}

struct MethodRow {
  IntegratorPointer (*make)(const SimTK::System&);
  double accuracy;  // of an adaptive method on the matched track; 0: its steps are fixed there
};

const MethodRow& row_of(const std::string& method) {
  static const std::map<std::string, MethodRow> rows = {
      {"cpodes", {make_of<SimTK::CPodesIntegrator>, 1e-9}},
      {"explicit-euler", {make_of<SimTK::ExplicitEulerIntegrator>, 0}},
      {"feldberg", {make_of<SimTK::RungeKuttaFeldbergIntegrator>, 1e-9}},
      {"merson", {make_of<SimTK::RungeKuttaMersonIntegrator>, 0}},
      {"rk2", {make_of<SimTK::RungeKutta2Integrator>, 0}},
      {"rk3", {make_of<SimTK::RungeKutta3Integrator>, 0}},
      {"semi-explicit-euler", {make_of<SimTK::SemiExplicitEulerIntegrator>, 0}},
      {"semi-explicit-euler-2", {make_of<SimTK::SemiExplicitEuler2Integrator>, 1e-4}},  // of order 1: tighter is slow
      {"verlet", {make_of<SimTK::VerletIntegrator>, 0}}};
  return rows.at(method);
}

// An integrator with a fixed step takes the whole way to its target as one step, if that is not longer than the fixed
// step. This one is longer than any, so each step may have its own length without a new integrator.
constexpr double kLongestStep = 1e9;  // s

// If a step's error estimate exceeds 2^p times the accuracy, Simbody keeps the step but projects neither constraints
// nor quaternions (AbstractIntegratorRep::attemptDAEStep). A fixed step therefore needs a loose accuracy. The same
// holds for constraint errors above the root of their tolerance.
constexpr double kLoosest = 0.5, kConstraintTolerance = 1e-3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Beyond it a state is one that blew up; MuJoCo draws the same line.
constexpr double kBlownUp = 1e10;

double largest_in(const SimTK::Vector& numbers) {  // infinite if one is not finite
  double largest = 0;
  for (int i = 0; i < numbers.size(); ++i)
    largest = std::max(largest, std::isfinite(numbers[i]) ? std::abs(numbers[i]) : kInfinity);
  return largest;
}

class SimbodyWorld : public World, public ReportsReactions {
 public:
  SimbodyWorld(const Scene& scene, const Settings& settings)
      : system_(scene),
        is_fixed_step_(simbody_steps(settings).are_fixed),
        integrator_(row_of(settings.method).make(system_.system())) {
    const SimbodySteps steps = simbody_steps(settings);
    if (steps.are_fixed) {
      integrator_->setFixedStepSize(kLongestStep);
      integrator_->setProjectEveryStep(true);
    }
    if (steps.accuracy) integrator_->setAccuracy(*steps.accuracy);
    if (steps.constraint_tolerance) integrator_->setConstraintTolerance(*steps.constraint_tolerance);
    // An integrator that steps past the end and interpolates would also step past a jump of the loads.
    const bool jumps = !scene.forces.empty() || !scene.motors.empty();
    if (!steps.reads_between || jumps) integrator_->setAllowInterpolation(false);
    has_servos_ =
        std::any_of(scene.motors.begin(), scene.motors.end(), [](const Motor& m) { return m.servo.has_value(); });
    moves_ = system_.start().getNU() > 0;
    if (!moves_) return;
    refuse_what_has_no_forces();
    integrator_->initialize(system_.start());
  }

  void step(double dt) override {
    double from = clock_.time();
    clock_.advance(dt);
    const double end = clock_.time();
    solver_warning_.clear();
    note_start(dt);
    while (moves_ && !lost_ && from < end) {  // parts in which no load begins or ends, so that none lies within a step
      const double to = system_.loads().next_switch(from, end);
      if (has_servos_) sample_servos(from);
      advance(from, to);
      from = to;
    }
  }

  Capabilities capabilities() override {
    Capabilities can;
    can.reactions = this;
    return can;
  }
  void ask_for_reactions() override {
    if (moves_) reactions_.emplace(system_);
  }
  void report_reactions(bool are_read) override { are_read_ = are_read; }
  std::vector<ReportedReaction> reactions() const override;

  void read(Snapshot& out) const override {
    out.time = clock_.time();
    const MutableBodyColumns columns = out.own(system_.scene().bodies.size());
    if (lost_) return set_lost(columns);
    const SimTK::State& state = moves_ ? integrator_->getState() : system_.start();
    system_.system().realize(state, SimTK::Stage::Velocity);
    system_.read(state, columns);
  }

  SettingsInForce settings_in_force() const override;
  std::string solver_warning() const override { return solver_warning_; }

 private:
  void refuse_what_has_no_forces() const;
  bool reports() const { return reactions_ && are_read_; }
  void note_start(double dt);
  void sample_servos(double t);
  void note_begin_of_part(double from, bool differs);
  void note_end_of_part(double from, double to, bool is_last);
  SimbodyReactions::Instant reactions_now() const;
  void advance(double from, double to);
  bool runs_away(double dt) const;
  void note_what_was_not_done(int failures);
  void set_lost(MutableBodyColumns out) const;

  SimbodySystem system_;
  bool is_fixed_step_;
  IntegratorPointer integrator_;
  Clock clock_;
  bool has_servos_ = false;
  std::optional<SimbodyReactions> reactions_;  // once asked
  bool are_read_ = true;                       // in this step
  BodyTable start_;                            // of the step
  double dt_ = 0;                              // s, of the step
  SimbodyReactions::Instant begin_, mean_;     // of the part of the step; of the step so far
  mutable SimbodyReactions::Instant end_;      // at end_time_
  mutable double end_time_ = kInfinity;        // s
  double share_ = 0;                           // of the step, that its last part takes
  bool moves_;                                 // something has a speed: CPODES aborts where nothing has
  bool lost_ = false;                          // blown up: from then on its state is "not a number"
  std::string solver_warning_;
};

// If all rows of the constraints repeat rows of the tree, the matrix G M⁻¹ Gᵀ contains only rounding. Simbody's ranks
// are relative, so it would treat it as a regular matrix. Squares of roundings are below 1e-30 of a usual row.
void SimbodyWorld::refuse_what_has_no_forces() const {
  SimTK::State state = system_.start();
  system_.system().realize(state, SimTK::Stage::Acceleration);
  if (state.getNMultipliers() == 0) return;
  SimTK::Matrix matrix;
  system_.matter().calcProjectedMInv(state, matrix);
  double heaviest = 0, largest = 0;  // kg or kg m²; 1/kg or 1/(kg m²)
  for (const Body& body : system_.scene().bodies)
    if (!body.fixed) heaviest = std::max({heaviest, body.mass, body.inertia.diagonal().maxCoeff()});
  for (int i = 0; i < matrix.nrow(); ++i) largest = std::max(largest, std::abs(matrix(i, i)));
  if (largest * heaviest > 1e-20) return;
  throw EngineFailure(FailureKind::unsupported,
                      "Simbody finds no forces for the joints that close loops: all that they say, others say already");
}

std::string in_one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

// Whether the state, or its speeds after a step of dt, exceed those of any motion.
bool SimbodyWorld::runs_away(double dt) const {
  SimTK::State state = integrator_->getAdvancedState();
  if (!(largest_in(state.getY()) < kBlownUp)) return true;
  try {
    system_.system().realize(state, SimTK::Stage::Acceleration);
  } catch (const std::exception&) {
    return false;
  }
  return !(dt * largest_in(state.getUDot()) < kBlownUp);
}

SimbodyReactions::Instant SimbodyWorld::reactions_now() const {
  SimTK::State state = integrator_->getAdvancedState();  // a copy: a run that is asked does not get its work done
  system_.system().realize(state, SimTK::Stage::Acceleration);
  return reactions_->at(state);
}

void SimbodyWorld::sample_servos(double t) {
  BodyTable now(system_.scene().bodies.size());
  system_.system().realize(integrator_->getState(), SimTK::Stage::Velocity);
  system_.read(integrator_->getState(), now.columns());
  system_.sample_servos(now.columns(), t);
}

void SimbodyWorld::note_start(double dt) {
  share_ = 0;
  if (!reports() || lost_) return;
  dt_ = dt;
  start_.resize(system_.scene().bodies.size());
  system_.system().realize(integrator_->getState(), SimTK::Stage::Velocity);
  system_.read(integrator_->getState(), start_.columns());
  mean_.assign(system_.scene().joints.size(), {});
}

// The joint loads of the last step's end are those of this start, unless the loads changed.
void SimbodyWorld::note_begin_of_part(double from, bool differs) {
  if (!reports()) return;
  begin_ = differs || end_time_ != from ? reactions_now() : end_;
}

// At the step's end that is only worked out if somebody asks.
void SimbodyWorld::note_end_of_part(double from, double to, bool is_last) {
  if (!reports()) return;
  const double share = (to - from) / dt_;
  if (!is_last) end_ = reactions_now(), end_time_ = to;
  for (std::size_t k = 0; k < mean_.size(); ++k) {
    const Vec3 none = Vec3::Zero();
    mean_[k].force += 0.5 * share * (begin_[k].force + (is_last ? none : end_[k].force));
    mean_[k].couple += 0.5 * share * (begin_[k].couple + (is_last ? none : end_[k].couple));
  }
  share_ = is_last ? share : 0;
}

std::vector<ReportedReaction> SimbodyWorld::reactions() const {
  if (!reactions_ || share_ == 0) return {};
  SimbodyReactions::Instant mean = mean_;
  if (!lost_ && end_time_ != clock_.time()) end_ = reactions_now(), end_time_ = clock_.time();
  for (std::size_t k = 0; k < mean.size(); ++k) {
    mean[k].force += 0.5 * share_ * end_[k].force;
    mean[k].couple += 0.5 * share_ * end_[k].couple;
  }
  return reactions_->reported(mean, start_.columns());
}

// The first call after a start returns at once, without a step. A change of the loads is such a start; values computed
// with the old loads must be invalidated first.
void SimbodyWorld::advance(double from, double to) {
  const int failures = integrator_->getNumConvergenceTestFailures();
  try {
    const bool differs = system_.set_interval(from, to);
    if (differs) {
      integrator_->updAdvancedState().invalidateAllCacheAtOrAbove(SimTK::Stage::Dynamics);
      integrator_->reinitialize(SimTK::Stage::Dynamics, false);
    }
    note_begin_of_part(from, differs);
    while (integrator_->getTime() < to) integrator_->stepTo(to, to);
    note_end_of_part(from, to, to == clock_.time());
  } catch (const std::exception& error) {
    if (!runs_away(to - from)) throw;  // its own failure: it costs the cell
    lost_ = true;
    solver_warning_ =
        fmt::format("Simbody gave up on numbers that passed {:g}: {}", kBlownUp, in_one_line(error.what()));
    return;
  }
  lost_ = !std::isfinite(largest_in(integrator_->getAdvancedState().getY()));
  if (is_fixed_step_) note_what_was_not_done(integrator_->getNumConvergenceTestFailures() - failures);
}

void SimbodyWorld::note_what_was_not_done(int failures) {
  if (failures > 0) solver_warning_ = "the step was kept although it did not converge, or its joints were too far open";
}

void SimbodyWorld::set_lost(MutableBodyColumns out) const {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const BodyState nowhere = {Vec3::Constant(kNaN), Quat(kNaN, kNaN, kNaN, kNaN), Vec3::Constant(kNaN),
                             Vec3::Constant(kNaN)};
  for (std::size_t i = 0; i < system_.scene().bodies.size(); ++i) {
    const Body& body = system_.scene().bodies[i];
    out.set_body(i, body.fixed ? BodyState{body.position, body.orientation, Vec3::Zero(), Vec3::Zero()} : nowhere);
  }
}

SettingsInForce SimbodyWorld::settings_in_force() const {
  const SimTK::Vec3 g = system_.gravity();
  const SimTK::State& state = moves_ ? integrator_->getState() : system_.start();
  const int equations = moves_ ? state.getNMultipliers() : 0;
  const std::string step =
      is_fixed_step_ ? "dt" : fmt::format("as its error asks: accuracy {:g}", integrator_->getAccuracyInUse());
  SettingsInForce in_force = {
      {"precision", sizeof(SimTK::Real) == sizeof(double) ? "double" : "single"},
      {"integrator", integrator_->getMethodName()},
      {"step", step},
      {"gravity", fmt::format("{:g}, {:g}, {:g} m/s^2", g[0], g[1], g[2])},
      {"coordinates", fmt::format("{} speeds of joints and free bodies", state.getNU())},
      {"springs", "its own, at each stage"},
      {"timed forces and motors", "at each stage; a step ends where one begins or ends"},
  };
  if (equations > 0) {
    in_force.emplace_back("loops", fmt::format("{} constraints, projected to {:g} after each step", equations,
                                               integrator_->getConstraintToleranceInUse()));
  }
  return in_force;
}

}  // namespace

std::string simbody_version() {
  int major = 0, minor = 0, build = 0;
  SimTK_version_simbody(&major, &minor, &build);
  return fmt::format("{}.{}.{}", major, minor, build);
}

OptionInfo simbody_accuracy(const std::string& method) {
  constexpr double kShipped = 1e-3;
  OptionInfo option;
  option.name = "accuracy", option.meaning = "error allowed in each inner step, relative to the state's scale";
  option.min = 1e-12, option.max = 0.1;
  option.by_default = row_of(method).accuracy, option.as_shipped = kShipped;
  return option;
}

SimbodySteps simbody_steps(const Settings& settings) {
  const bool matched = settings.track == Track::matched, is_fixed = row_of(settings.method).accuracy == 0;
  if (is_fixed && matched) return {true, kLoosest, kConstraintTolerance, false};
  if (settings.method == "semi-explicit-euler") return {true, {}, {}, false};  // it estimates no error
  if (is_fixed) return {false, {}, {}, true};
  const std::optional<double> accuracy = number_to_set(settings, simbody_accuracy(settings.method));
  return matched ? SimbodySteps{false, accuracy, accuracy, false} : SimbodySteps{false, accuracy, {}, true};
}

std::unique_ptr<World> simbody_world(const Scene& scene, const Settings& settings) {
  return std::make_unique<SimbodyWorld>(scene, settings);
}

}  // namespace rigor::inline adapters
