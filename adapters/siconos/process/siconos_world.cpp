#include "adapters/siconos/process/siconos_world.h"

#include <fmt/format.h>

#include <Friction_cst.h>
#include <SolverOptions.h>
#include <Equality.hpp>
#include <GenericMechanical.hpp>
#include <NonSmoothDynamicalSystem.hpp>
#include <TimeDiscretisation.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "adapters/siconos/process/siconos_joints.h"
#include "adapters/siconos/siconos_matched.h"

namespace rigor::inline adapters::siconos {
namespace {

// The last result of Siconos's contact solver: 0 if it converged. Siconos has one such place per process.
int last_answer = 0;

void keep_answer(int answer, Simulation*) { last_answer = answer; }

}  // namespace

SiconosWorld::SiconosWorld(Scene scene, const StepSettings& settings)
    : scene_(std::move(scene)),
      settings_(settings),
      bodies_(std::make_unique<Bodies>(scene_)),
      contacts_(std::make_shared<Contacts>(scene_, *bodies_)) {}

std::shared_ptr<LinearOSNS> SiconosWorld::contact_problem() {
  std::shared_ptr<LinearOSNS> problem;
  if (scene_.joints.empty()) {  // Siconos asks for a problem where nothing can touch, too
    problem = std::make_shared<FrictionContact>(3, SICONOS_FRICTION_3D_NSGS);
  } else if (!contacts_->is_needed()) {
    return std::make_shared<Equality>();
  } else {
    problem = std::make_shared<GenericMechanical>(SICONOS_FRICTION_3D_ONECONTACT_NSN);
  }
  SolverOptions& options = *problem->numericsSolverOptions();
  if (settings_.iterations) options.iparam[SICONOS_IPARAM_MAX_ITER] = *settings_.iterations;
  if (settings_.tolerance) options.dparam[SICONOS_DPARAM_TOL] = *settings_.tolerance;
  if (settings_.is_matched) {
    if (scene_.joints.empty()) {  // the whole law is looked at, and each contact solved to roundings, at each sweep
      options.iparam[SICONOS_FRICTION_3D_IPARAM_ERROR_EVALUATION] = SICONOS_FRICTION_3D_NSGS_ERROR_EVALUATION_FULL;
      options.iparam[SICONOS_FRICTION_3D_IPARAM_INTERNAL_ERROR_STRATEGY] =
          SICONOS_FRICTION_3D_INTERNAL_ERROR_STRATEGY_GIVEN_VALUE;
      options.internalSolvers[0]->dparam[SICONOS_DPARAM_TOL] = 1e-14;
      options.internalSolvers[0]->iparam[SICONOS_IPARAM_MAX_ITER] = 100;
    }
  }
  problem->setKeepLambdaAndYState(true);
  return problem;
}

// Siconos keeps one step size for the whole of a simulation: with another one a new simulation goes on from the state.
void SiconosWorld::start(double time, double dt) {
  constexpr double kNoEnd = 1e9;  // s
  dt_ = dt;
  contacts_->forget();
  contacts_->set_step(dt);
  bodies_->make_systems(settings_.theta, dt);
  system_ = std::make_shared<NonSmoothDynamicalSystem>(time, kNoEnd);
  for (const BodyPointer& body : bodies_->systems())
    if (body) system_->insertDynamicalSystem(body);
  link_joints(scene_, *bodies_, *system_);
  integrator_ = std::make_shared<MoreauJeanOSI>(settings_.theta);
  if (settings_.is_matched) integrator_->setConstraintActivationThreshold(kSiconosTouching);
  problem_ = contact_problem();
  const auto steps = std::make_shared<TimeDiscretisation>(time, dt);
  simulation_ = std::make_shared<TimeStepping>(system_, steps, 0);
  simulation_->insertIntegrator(integrator_);
  simulation_->insertNonSmoothProblem(problem_);
  if (contacts_->is_needed()) simulation_->insertInteractionManager(contacts_);
  if (settings_.is_matched) set_newton();
  simulation_->setCheckSolverFunction(keep_answer);
  simulation_->initialize();
}

// Siconos stops at a residual momentum [N s, N m s], which adds up over thousands of steps. Heavier bodies have larger
// rounding, and then all iterations are made. Contact is of first order and stands out from rounding earlier.
void SiconosWorld::set_newton() {
  const double rounding = contacts_->is_needed() ? 1e-12 : 1e-15;  // m/s, rad/s
  double lightest = std::numeric_limits<double>::infinity();
  for (const Body& body : scene_.bodies)
    if (!body.fixed) lightest = std::min({lightest, body.mass, body.inertia.diagonal().minCoeff()});
  simulation_->setNewtonTolerance(rounding * lightest);
  simulation_->setNewtonMaxIteration(contacts_->is_needed() ? kSiconosPassesWithContacts : kSiconosPasses);
  simulation_->setWarnOnNonConvergence(false);
}

// Rounding of heavy bodies and large loads may exceed the tolerance; ten million times the tolerance is no rounding.
void SiconosWorld::look_back() {
  constexpr double kNoRounding = 1e7;  // times the tolerance
  constexpr double kTooFar =
      1e-6;  // of the impulses: sweeps over stacks come near to a tolerance of roundings, not to it
  const double left =
      problem_->numericsSolverOptions() ? problem_->numericsSolverOptions()->dparam[SICONOS_DPARAM_RESIDU] : 0;
  if (last_answer != 0 && !(left < kTooFar)) {
    warning_ = fmt::format("Siconos's solver of contacts ended {:.2g} from its law, short of its tolerance", left);
  } else if (simulation_->newtonResiduDSMax() > kNoRounding * simulation_->newtonTolerance()) {
    warning_ = fmt::format("Siconos's Newton iteration left {:.2g} N s", simulation_->newtonResiduDSMax());
  }
}

void SiconosWorld::step(double dt) {
  const double begin = clock_.time();
  clock_.advance(dt);
  warning_.clear(), reports_.clear();
  bodies_->loads().for_each_smooth_part(begin, dt, [&](double from, double length) {
    if (lost_body() < 0) step_part(from, length, dt);
  });
}

// `whole`: s, the step that this is a part of. Loads begin or end between two simulations, because a simulation
// remembers the forces at its last step's end.
void SiconosWorld::step_part(double from, double dt, double whole) {
  const double middle = from + 0.5 * dt;
  try {
    const bool has_switched = bodies_->loads().next_switch(middle_, middle) != middle;
    middle_ = middle;
    bodies_->set_time(middle);
    if (dt != dt_ || has_switched) start(from, dt);
    last_answer = 0;
    simulation_->computeOneStep();
    contacts_->add_forces(whole, reports_);
    simulation_->nextStep();
    bodies_->gather();
    look_back();
  } catch (const std::exception&) {  // it gives up on numbers that are not finite, too
    bodies_->gather();
    if (lost_body() < 0) throw;
  }
}

int SiconosWorld::lost_body() const {
  constexpr double kBlownUp = 1e10;  // MuJoCo and Simbody draw the same line
  for (std::size_t i = 0; i < state().size(); ++i)
    for (int c = 0; c < 13; ++c)
      if (!(std::abs(state().column(c)[i]) < kBlownUp)) return static_cast<int>(i);
  return -1;
}

std::vector<std::pair<std::string, std::string>> SiconosWorld::settings_in_force() const {
  std::vector<std::pair<std::string, std::string>> in_force = {
      {"precision", "double"},
      {"integrator", "Moreau and Jean's, by Newton's method"},
      {"theta", fmt::format("{}", settings_.theta)},
      {"loads", "springs, forces and motors by Rigor's law, at both ends of a step"}};
  if (!scene_.joints.empty()) in_force.emplace_back("joints", "held at the velocities of the step's end");
  if (!contacts_->is_needed()) return in_force;
  in_force.emplace_back("contact points", "Rigor's narrow phase; Siconos's own is in single precision");
  in_force.emplace_back("contact law",
                        "Newton's restitution, Coulomb's cone; skewed on slopes, by Siconos's own frame");
  const auto told = [](const auto& value) { return value ? fmt::format("{:g}", 1.0 * *value) : "as shipped"; };
  in_force.emplace_back("contact solver", "Gauss-Seidel; sweeps: " + told(settings_.iterations) +
                                              "; tolerance: " + told(settings_.tolerance));
  return in_force;
}

}  // namespace rigor::inline adapters::siconos
