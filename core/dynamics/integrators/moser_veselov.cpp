// The variational integrator whose rotation is the discrete Moser–Veselov equation (J. Moser, A. P. Veselov, 1991; with
// loads: T. Lee, M. Leok, N. H. McClamroch, Lie group variational integrators, 2007). Half a kick, a drift, half a
// kick, as the leapfrog; in the drift L is constant, R1 = R0 F, and F solves
//   dt [Rᵀ L]x = F J_d - J_d Fᵀ,   J_d = tr(J)/2 - J,
// which for F = (1 + [f]x) (1 - [f]x)⁻¹ is  2 (J f + f x J f) = (1 + |f|²) dt Rᵀ L,  solved by Newton's method.
// About a principal axis it says sin(angle) = dt w: there is no solution once a body turns by about a radian a step.
#include <Eigen/LU>

#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/symmetric_kick.h"

namespace rigor {
namespace {

constexpr int kMostIterations = 50;
constexpr double kLastCorrection = 1e-9;  // relative; Newton's next correction is about its square

// Solves for f from the explicit guess; false where there is no solution on the branch that begins at f = 0. The
// determinant of the derivative is positive there and vanishes where the branch ends.
bool solve_moser_veselov(const Mat3& J, const Vec3& a, Vec3& f) {
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const Vec3 Jf = J * f;
    const Vec3 residual = 2 * (Jf + f.cross(Jf)) - (1 + f.squaredNorm()) * a;
    const Mat3 derivative = 2 * (J + cross_matrix(f) * J - cross_matrix(Jf) - a * f.transpose());
    const double determinant = derivative.determinant();
    const Vec3 correction = derivative.inverse() * residual;
    if (!correction.allFinite()) return false;
    f -= correction;
    if (correction.norm() <= kLastCorrection * (1 + f.norm())) return determinant > 0;
  }
  return false;
}

class MoserVeselov : public Stepper {
 public:
  explicit MoserVeselov(const StepperParts& parts) : parts_(parts), kick_(parts.system) {}

  void step(MutableBodyColumns state, double t, double dt) override {
    complaint_.clear();
    kick_.begin(state);
    kick(state, t, dt);
    if (parts_.contact) resolve_contact(state);
    for (std::size_t i = 0; i < state.size(); ++i) drift(state, i, dt);
    kick(state, t, dt);
    kick_.end(state);
  }

  std::string complaint() const override { return complaint_; }

 private:
  void kick(MutableBodyColumns state, double t, double dt) {
    if (!kick_.apply(state, 0.5 * dt, t, dt)) complaint_ = kNoSymmetricKick;
  }

  void resolve_contact(MutableBodyColumns state) {
    kick_.end(state);
    parts_.contact->resolve(state);
    kick_.begin(state);
  }

  void drift(MutableBodyColumns state, std::size_t i, double dt) {
    const Inertia& body = parts_.system.bodies[i];
    if (body.fixed) return;
    const Vec3 L_B = state.rotation(i).transpose() * kick_.angular_momentum(i);
    const Vec3 guess = 0.5 * dt * (body.inverse_inertia_B * L_B);
    Vec3 f = guess;
    if (!solve_moser_veselov(body.inertia_B, dt * L_B, f)) {
      complaint_ = "the discrete Moser-Veselov equation has no solution for so much rotation in a step";
      f = guess;
    }
    const Quat turn(1, f.x(), f.y(), f.z());
    state.set_position(i, state.position(i) + dt * state.velocity(i));
    state.set_orientation(i, (state.orientation(i) * turn).normalized());
  }

  StepperParts parts_;
  SymmetricKick kick_;
  std::string complaint_;
};

}  // namespace

extern const Integrator kMoserVeselov;
const Integrator kMoserVeselov = {
    .name = "moser-veselov",
    .summary = "the variational discrete rotation of Moser and Veselov with a leapfrog; keeps |L| to rounding",
    .order = 2,
    .symplectic = true,
    .velocity_lag = 0,
    .default_orientation = "",
    .make = make_stepper<MoserVeselov>,
};

}  // namespace rigor
