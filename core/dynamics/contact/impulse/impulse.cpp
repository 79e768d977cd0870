// Contact by sequential impulses (projected Gauss-Seidel) in small sub-steps with soft constraints, for piles (Macklin
// et al., Small steps in physics simulation, 2019; Catto, Soft constraints, 2011; Catto, Solver2D, 2024: "soft step").
// A sub-step of length h: the bodies move freely by the integrator's scheme; the impulses of the sub-step before are
// applied (warm start); then each constraint in turn gets, with its relative velocity u and inverse effective masses k,
//   p_n <- max(0, p_n - mass_scale (u_n + bias) / k_n - impulse_scale p_n),
//   p_t <- onto the disc of radius mu p_n (p_t - u_t / k_t),
// where the bias lets a gap close within h, or pushes an overlap out like a damped spring of contact_hertz. The
// positions are integrated with these velocities. Then the constraints are relaxed, which is the same without bias, so
// that pushed bodies keep no speed. The first sub-step of a run has no impulses to start from. With up to
// 1000 contacts it repeats both passes until they agree, with points that touch as rigid ones. From then on these carry
// their load without an overlap (ContactRowLayout::carry_without_overlap()). Fast contacts that bounce have their
// impacts before, each at its own instant of the sub-step (rebounds.h). The row arithmetic, several rows at a time, is
// in kernels/contact_row_kernels-inl.h.
#include <fmt/format.h>

#include <algorithm>

#include "core/dynamics/contact/contact_method.h"
#include "core/dynamics/contact/impulse/contact_row_layout.h"
#include "core/dynamics/contact/impulse/jointed_impulse.h"
#include "core/dynamics/contact/impulse/manifolds.h"
#include "core/dynamics/contact/impulse/mean_motion.h"
#include "core/dynamics/contact/impulse/rebounds/impact_search.h"
#include "core/dynamics/contact/impulse/rebounds/rebounds.h"
#include "core/dynamics/contact/impulse/step_impulses.h"
#include "core/dynamics/contact/impulse/sub_steps.h"
#include "core/dynamics/contact/impulse/turning_friction.h"
#include "core/dynamics/kernels/contact_kernels.h"
#include "core/engine/engine_failure.h"
#include "core/engine/state_archive.h"

namespace rigor::inline dynamics {
namespace {

// With fewer bodies threads would wait for each other longer than they work.
constexpr std::size_t kWorthSharing = 128;

std::shared_ptr<ThreadPool> threads_for(const BodyConstants& bodies) {
  const bool is_worth = bodies.thread_pool() && bodies.size() >= kWorthSharing;
  return is_worth ? bodies.thread_pool() : std::make_shared<ThreadPool>(1);
}

// As integrate_corrections(), for the orientations of an integrator that keeps matrices.
void turn_matrices(const Bodies& bodies, const AlignedDoubles& velocities, double h, MutableBodyColumns state) {
  for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
    const Vec3 w = Eigen::Map<const Vec3>(velocities.data() + kRecord * i + 3);
    const Vec3 turn = h * (w - state.angular_velocity(i));
    if (!turn.isZero(0)) state.set_rotation(i, rotation_by(turn).toRotationMatrix() * state.rotation(i));
  }
}

class ImpulseStepper : public ContactStepper {
 public:
  ImpulseStepper(const Scene& scene, const ContactParts& parts)
      : system_(parts.system),
        threads_(threads_for(parts.system.constants)),
        sub_steps_(scene, parts),
        manifolds_(scene, *threads_),
        rows_(scene, parts.system, threads_->members()),
        search_(threads_->members()),
        impacts_(rows_, *threads_),
        many_passes_(rows_, *threads_),
        turning_(scene),
        rebounds_(parts.system, SubSteps::takes_impacts_at_once(parts.settings)),
        mean_motion_(parts.integrator),
        positions_(kVelocity, parts.system.size()),
        integrator_(parts.integrator.make({parts.system, nullptr, parts.orientation, parts.settings})) {
    for (AlignedDoubles* records : {&velocities_, &displacements_, &pushes_, &inverse_inertias_})
      records->assign(kRecord * rows_.records(), 0.0);
    inverse_inertias_[kRecord * rows_.idle_body() + 6] = 1;  // 1/kg, of which rows divide by the sum
  }

  void step(MutableBodyColumns state, double t, double dt) override {
    if (!(dt > 0)) return integrator_->step(state, t, dt);
    const int count = sub_steps_.of(dt), updates = sub_steps_.contact_updates(dt, count);
    const double h = dt / count;
    reports_.begin_step();
    for (int update = 0, k = 0; update < updates; ++update) {
      const int end = (update + 1) * count / updates;
      std::vector<ContactConstraint>& constraints = manifolds_.find(state, (end - k) * h);
      prepare(state, constraints, h);
      if (reports_.is_asked()) reports_.begin_update(constraints, state);
      for (const int first = k; k < end; ++k) {
        prepare_sub_step();
        move_freely(state, t + k * h);
        threads_->run([&](std::size_t thread) { solve_sub_step(state, k == first, thread); });
        if (!are_impulses_known_) rows_.carry_without_overlap(constraints, parameters_);
        are_impulses_known_ = true;
        if (reports_.is_asked()) reports_.add_rows(rows_, constraints);
      }
      threads_->run([&](std::size_t thread) { rows_.store_impulses(constraints, thread); });
      if (reports_.is_asked()) reports_.end_update();
    }
    reports_.end_step(dt);
  }

  ReportsContacts* contact_reports() override { return &reports_; }

  std::string solver_warning() const override {
    const std::string warning = integrator_->solver_warning();
    return warning.empty() ? manifolds_.failure() : warning;
  }

  void archive_state(StateArchive& archive) override {
    archive(parameters_.h, manifolds_, turning_);
    integrator_->archive_state(archive);
  }

  std::optional<double> sub_step() const override {
    return parameters_.h > 0 ? std::optional(parameters_.h) : std::nullopt;
  }

  SettingsInForce settings_in_force() const override {
    SettingsInForce settings = sub_steps_.settings_in_force();
    settings.insert(settings.begin(), {{"contact solver", "sequential impulses, two passes a sub-step, warm start"},
                                       {"restitution", "at each impact's instant, no further than its energy allows"},
                                       {"several impacts at once", rebounds_.law()}});
    return settings;
  }

 private:
  // For sub-steps of h with these contacts: effective masses, and the last impulses and overlaps, scaled to h.
  void prepare(BodyColumns state, std::vector<ContactConstraint>& constraints, double h) {
    const double impulse_scale = parameters_.h > 0 ? h / parameters_.h : 1;
    if (impulse_scale != 1) {
      for (ContactConstraint& point : constraints) point.rest_overlap *= impulse_scale * impulse_scale;
    }
    are_impulses_known_ = parameters_.h > 0 || constraints.size() > SubSteps::kMostAtRest;
    parameters_ = sub_steps_.parameters(h);
    rows_.assign(constraints, are_impulses_known_);
    search_.begin(rows_);
    many_passes_.clear();
    const std::vector<RowPlace>& many = rows_.rows_of_many_passes();
    many_passes_.add(many.data(), many.data() + many.size());
    many_passes_.form_groups();
    threads_->run([&](std::size_t thread) {
      const Bodies bodies = share_of_bodies(thread);
      for (int c = 0; c < kVelocity; ++c)
        std::copy(state.column(c) + bodies.begin, state.column(c) + bodies.end, positions_.column(c) + bodies.begin);
      std::fill(displacements_.begin() + at_record(bodies.begin), displacements_.begin() + at_record(bodies.end), 0.0);
      kernels().gather_velocities(bodies, state.column(0), velocities_.data());
      kernels().gather_inverse_inertias(bodies, state.column(0), inverse_inertias_.data());
      threads_->meet();
      rows_.fill(constraints, impulse_scale, solver_bodies(), thread);
    });
    turning_.assign(constraints, rows_, impulse_scale, solver_bodies());
  }

  // Gaps and the speeds at which they close, before the bodies move, and with them the biases. The velocities are those
  // that the last sub-step has left.
  void prepare_sub_step() {
    threads_->run([&](std::size_t thread) { search_.find(rows_, solver_bodies(), of_sweeps(), thread); });
    search_.give(rows_, impacts_);
  }

  // And, where bodies bounce, as the impacts of the sub-step let them.
  void move_freely(MutableBodyColumns state, double t) {
    const bool are_rebounds = rows_.has_restitution() && impacts_.are_any();
    if (are_rebounds) rebounds_.begin(state);
    mean_motion_.begin(state);
    integrator_->step(state, t, parameters_.h);
    mean_motion_.end(state);
    if (!are_rebounds) return;
    rebounds_.resolve(rows_.groups(), parameters_, state);
    if (reports_.is_asked()) reports_.add_impacts(rows_, rebounds_.impulses());
  }

  // A thread's share of the effects of impulses. Between two contact updates an impulse always has the same effect on
  // its bodies, so those of the last sub-step are not applied again one by one.
  void solve_sub_step(MutableBodyColumns state, bool is_first, std::size_t thread) {
    const Bodies bodies = share_of_bodies(thread);
    if (is_first) {
      kernels().gather_velocities(bodies, state.column(0), velocities_.data());
      threads_->meet();
      warm_start(thread);
    } else {
      contact_kernels().gather_pushed(bodies, state.column(0), pushes_.data(), velocities_.data());
      threads_->meet();
    }
    solve_with_bias(thread);
    integrate_corrections(bodies, state);
    threads_->meet();
    relax(thread);
    contact_kernels().scatter_pushed(bodies, velocities_.data(), state.column(0), pushes_.data());
  }

  // Calls pass(groups, their number) for a thread's share of each colour; all threads have done one colour before any
  // goes on to the next.
  template <typename Pass>
  void for_each_colour(std::size_t thread, const Pass& pass) {
    for (std::size_t colour = 0; colour < rows_.colours(); ++colour) {
      const auto [begin, end] = rows_.share(colour, thread);
      pass(rows_.groups().data() + begin, end - begin);
      threads_->meet();
    }
  }

  void warm_start(std::size_t thread) {
    for_each_colour(thread, [&](const RowGroup* groups, std::size_t count) {
      contact_kernels().warm_start(groups, count, solver_bodies());
    });
    by_one_thread(thread, [&] { turning_.warm_start(solver_bodies()); });
  }

  // A body that lands flat must not begin to rotate because of the order of its corners. Impacts are therefore solved
  // until they agree. So are all contacts in the first sub-step, because no impulses of an earlier one make a good
  // start.
  void solve_with_bias(std::size_t thread) {
    for_each_colour(thread, [&](const RowGroup* groups, std::size_t count) {
      contact_kernels().solve_with_bias(groups, count, solver_bodies(), of_sweeps());
    });
    RowSweeps& to_agree = are_impulses_known_ ? impacts_ : many_passes_;
    to_agree.solve(contact_kernels().sweep_with_bias, solver_bodies(), of_sweeps(), thread);
    by_one_thread(thread, [&] { turning_.solve(solver_bodies()); });
  }

  // Rolling and torsional friction, which few scenes have, while the other threads wait.
  template <typename Work>
  void by_one_thread(std::size_t thread, const Work& work) {
    if (!turning_.are_any()) return;
    if (thread == 0) work();
    threads_->meet();
  }

  // The integrator has moved the bodies; the velocity changes by the impulses move them further.
  void integrate_corrections(const Bodies& bodies, MutableBodyColumns state) {
    const double h = parameters_.theta * parameters_.h;
    if (mean_motion_.is_needed()) {
      for (std::size_t i = bodies.begin; i < bodies.end; ++i)
        if (is_pushed(i, state)) mean_motion_.apply(i, h, state);
    }
    if (state.has_rotation()) turn_matrices(bodies, velocities_, h, state);
    contact_kernels().integrate_corrections(bodies, velocities_.data(), h, state.column(0), positions_.column(0),
                                            displacements_.data());
  }

  bool is_pushed(std::size_t body, BodyColumns state) const {
    const double* record = velocities_.data() + kRecord * body;
    return Eigen::Map<const Vec3>(record) != state.velocity(body) ||
           Eigen::Map<const Vec3>(record + 3) != state.angular_velocity(body);
  }

  // The bias of an impact may be as large as its speed. Without it, the corners must again agree. A body that is pushed
  // out of a deep overlap must not keep the residual push of one pass.
  void relax(std::size_t thread) {
    if (are_impulses_known_) impacts_.solve(contact_kernels().sweep_without_bias, solver_bodies(), parameters_, thread);
    for_each_colour(thread, [&](const RowGroup* groups, std::size_t count) {
      contact_kernels().relax(groups, count, solver_bodies());
    });
    many_passes_.solve(contact_kernels().sweep_without_bias, solver_bodies(), of_sweeps(), thread);
    // Some integrators leave the normal impulse of a body at rest to this pass.
    by_one_thread(thread, [&] { turning_.solve(solver_bodies()); });
  }

  SolverParameters of_sweeps() const {
    return are_impulses_known_ ? parameters_ : SubSteps::until_at_rest(parameters_, rows_.rows_of_many_passes().size());
  }

  static std::ptrdiff_t at_record(std::size_t body) { return static_cast<std::ptrdiff_t>(kRecord * body); }
  Bodies share_of_bodies(std::size_t thread) const {
    Bodies bodies = system_.constants.all();
    const auto [first, last] = threads_->share(bodies.end, thread, kRowsPerLine);
    bodies.begin = first, bodies.end = last;
    return bodies;
  }
  SolverBodies solver_bodies() { return {velocities_.data(), displacements_.data(), inverse_inertias_.data()}; }

  const System& system_;
  std::shared_ptr<ThreadPool> threads_;
  SubSteps sub_steps_;
  Manifolds manifolds_;
  ContactRowLayout rows_;
  ImpactSearch search_;
  RowSweeps impacts_, many_passes_;  // points that meet in this sub-step; see rows_of_many_passes()
  bool are_impulses_known_ = false;  // from a sub-step before
  TurningFriction turning_;
  Rebounds rebounds_;
  MeanMotion mean_motion_;
  StepImpulses reports_;
  SolverParameters parameters_{};
  AlignedDoubles velocities_, displacements_, inverse_inertias_;  // see SolverBodies
  AlignedDoubles pushes_;  // the velocity changes by the impulses of the last sub-step
  Columns positions_;      // the state's poses when contacts were last updated
  std::unique_ptr<Stepper> integrator_;
};

// Impacts at their own instants, also of contacts that others push, and rows that act through joints have no couples.
void refuse_turning_friction(const Scene& scene, bool has_joints) {
  const bool resists = any_law(scene, [](const ContactLaw& law) { return law.resists_turning(); });
  const bool bounces = any_law(scene, [](const ContactLaw& law) { return law.restitution > 0; });
  if (!resists || (!bounces && !has_joints)) return;
  throw EngineFailure(FailureKind::unsupported,
                      fmt::format("contact=impulse has no rolling or torsional friction in a scene with {}",
                                  bounces ? "restitution" : "joints"));
}

// No impact adds energy (rebounds/impact_energy.h). That bound counts the bodies alone, and a rotor also has energy.
void refuse_bouncing_rotors(const Scene& scene) {
  const bool bounces = any_law(scene, [](const ContactLaw& law) { return law.restitution > 0; });
  const bool has_rotors =
      std::any_of(scene.joints.begin(), scene.joints.end(), [](const Joint& joint) { return joint.armature > 0; });
  if (bounces && has_rotors)
    throw EngineFailure(FailureKind::unsupported, "contact=impulse has no restitution in a scene with armatures");
}

std::unique_ptr<ContactStepper> make_impulse_stepper(const Scene& scene, const ContactParts& parts) {
  refuse_turning_friction(scene, parts.joints != nullptr);
  refuse_bouncing_rotors(scene);
  if (parts.joints) return make_jointed_impulse_stepper(scene, parts);
  return std::make_unique<ImpulseStepper>(scene, parts);
}

}  // namespace

extern const ContactMethod kImpulseContact;
const ContactMethod kImpulseContact = {
    .name = "impulse",
    .summary = "velocities corrected in small sub-steps, with warm starting; for piles",
    .features =
        joined(contacts_in_collision(),
               {Feature::placed_shapes, Feature::contact_filter, Feature::friction_coulomb, Feature::friction_infinite,
                Feature::friction_none, Feature::restitution, Feature::rolling_friction, Feature::torsional_friction,
                Feature::joints_with_contacts, Feature::joint_limit, Feature::joint_limit_of_compound_slider,
                Feature::motor_speed, Feature::joint_friction}),
    .options = {kSubStepsOption, kImpactsOption},
    .make = make_impulse_stepper,
};

}  // namespace rigor::inline dynamics
