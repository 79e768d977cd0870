// The variational integrator whose rotation is the discrete Moser–Veselov equation (J. Moser, A. P. Veselov, 1991; with
// loads: T. Lee, M. Leok, N. H. McClamroch, Lie group variational integrators, 2007). Half a kick, a drift, half a
// kick, as the leapfrog; in the drift L is constant, R1 = R0 F, and F solves
//   dt [Rᵀ L]x = F J_d - J_d Fᵀ,   J_d = tr(J)/2 - J,
// which for F = (1 + [f]x) (1 - [f]x)⁻¹ is  2 (J f + f x J f) = (1 + |f|²) dt Rᵀ L,  solved by Newton's method.
// About a principal axis it says sin(angle) = dt w: there is no solution once a body turns by about a radian a step.
#include "core/dynamics/integrators/constrained_drift.h"
#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/integrators/symmetric_kick.h"
#include "core/engine/state_archive.h"

namespace rigor::inline dynamics {
namespace {

class MoserVeselov : public Stepper {
 public:
  explicit MoserVeselov(const StepperParts& parts) : parts_(parts), kick_(parts.system), drift_(parts) {}

  void step(MutableBodyColumns state, double t, double dt) override {
    solver_warning_.clear();
    drift_.begin(state);
    kick_.begin(state);
    kick(state, t, dt);
    if (parts_.contact) resolve_contact(state);
    drift_.drift(state, kick_.carried_columns(), dt, [&](MutableBodyColumns at, const double* carried) {
      if (!kernels().moser_veselov_drift(parts_.system.constants.all(), at.column(0), carried, dt))
        solver_warning_ = "the discrete Moser-Veselov equation has no solution for so much rotation in a step";
    });
    kick(state, t, dt);
    drift_.settle(state, kick_.carried_columns());
    kick_.end(state);
  }

  std::string solver_warning() const override { return solver_warning_; }
  void archive_state(StateArchive& archive) override { archive(solver_warning_); }

 private:
  void kick(MutableBodyColumns state, double t, double dt) {
    if (!kick_.apply(state, 0.5 * dt, t, dt)) solver_warning_ = kNoSymmetricKick;
  }

  void resolve_contact(MutableBodyColumns state) {
    kick_.end(state);
    parts_.contact->resolve(state);
    kick_.begin(state);
  }

  StepperParts parts_;
  SymmetricKick kick_;
  ConstrainedDrift drift_;
  std::string solver_warning_;
};

}  // namespace

extern const Integrator kMoserVeselov;
const Integrator kMoserVeselov = {
    .name = "moser-veselov",
    .summary = "the variational discrete rotation of Moser and Veselov with a leapfrog; keeps |L| to rounding",
    .order = 2,
    .symplectic = true,
    .symmetric = true,
    .leapfrog_stagger = 0,
    .default_orientation = "",
    .takes_joints = true,
    .takes_dampers_with_joints = false,
    .make = make_stepper<MoserVeselov>,
};

}  // namespace rigor::inline dynamics
