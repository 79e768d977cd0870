// An exponential Adams–Bashforth method of order 4 (Hochbruck, Ostermann, Exponential integrators, Acta Numerica 19,
// 2010, section 2.5). Near a pose (X, Q) that a body was at, its motion is
//   u = (x - X, phi, v, e),  R = exp([phi]x) Q,  e = J⁻¹ L,  J the inertia in W at Q,
//   u' = A u + g(u),  A = [0 1; M⁻¹ P, M⁻¹ D],  M = (m, J),
// P and D are the derivatives of the body's own wrench by its own pose and velocity there. The part of A is solved
// exactly for any size. The rest g is the cubic through its values at the last four instants:
//   u(t + h) = exp(hA) u(t) + h (B0 g(t) + B1 g(t - h) + B2 g(t - 2h) + B3 g(t - 3h)).
// A body on linear springs and dampers along fixed lines therefore moves exactly at any step. Interaction between
// bodies stays in g, so a stiff spring between two moving bodies still bounds the step.
//
// One evaluation of the loads a step. A new pose is chosen when a body has turned by 1 rad from the last. The first
// four instants (at the start, after another dt) are found together, by iteration; a step in which a
// timed force begins or ends is left to the adaptive method of Dormand and Prince.
#include <algorithm>

#include "core/base/rotation_vector.h"
#include "core/dynamics/integrators/continuation.h"
#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/integrators/phi_functions.h"
#include "core/dynamics/model/loads/load_jacobian.h"
#include "core/engine/state_archive.h"

namespace rigor::inline dynamics {
namespace {

using Vec12 = Eigen::Matrix<double, 12, 1>;

constexpr int kNodes = 4;
using Nodes = std::array<int, kNodes>;  // instants at which g is known, in steps from the start of the step
constexpr Nodes kBehind = {0, -1, -2, -3};
using Weights = std::array<Mat12, kNodes>;

// B_j h for the polynomial through the nodes.
Weights weights_of(const PhiFunctions& phi, const Nodes& nodes, double h) {
  Weights weights;
  for (int j = 0; j < kNodes; ++j) {
    // Lagrange's polynomial of the node: c[0] + c[1] s + c[2] s² + c[3] s³.
    std::array<double, kNodes> c = {1};
    for (int k = 0, degree = 0; k < kNodes; ++k) {
      if (k == j) continue;
      const double scale = 1.0 / (nodes[j] - nodes[k]);
      ++degree;
      for (int p = degree; p >= 0; --p) c[p] = scale * ((p > 0 ? c[p - 1] : 0) - nodes[k] * c[p]);
    }
    weights[j] = h * (c[0] * phi[1] + c[1] * phi[2] + 2 * c[2] * phi[3] + 6 * c[3] * phi[4]);
  }
  return weights;
}

// One body's motion about its pose of reference.
struct Frame {
  Vec3 position = Vec3::Zero();
  Quat orientation = Quat::Identity();
  Mat3 inverse_inertia_W = Mat3::Zero(), inertia_W = Mat3::Zero();
  Mat12 linear = Mat12::Zero(), exponential = Mat12::Identity();
  Weights behind;
  std::array<Weights, kNodes - 1> starting;  // of the first three steps, through the first four instants

  void archive_state(StateArchive& archive) {
    archive(position, orientation, inverse_inertia_W, inertia_W, linear, exponential, behind, starting);
  }
};

// What is known at an instant.
struct Instant {
  Vec12 u = Vec12::Zero(), rest = Vec12::Zero();  // rest: g
  Wrench wrench;

  void archive_state(StateArchive& archive) { archive(u, rest, wrench.force, wrench.torque); }
};

class ExponentialAdams : public Stepper {
 public:
  explicit ExponentialAdams(const StepperParts& parts)
      : parts_(parts),
        last_(parts.system.size()),
        frames_(parts.system.size()),
        scratch_(parts.system.size()),
        switching_(integrator("dormand-prince").make({parts.system, nullptr, nullptr, {}})) {
    for (auto& instant : instants_) instant.resize(parts.system.size());
  }

  void step(MutableBodyColumns state, double t, double dt) override {
    solver_warning_.clear();
    const double oldest = t - (kNodes - 1 - ahead_) * dt;
    const bool goes_on = known_ && last_.goes_on(state, t, dt, parts_.system.loads, oldest);
    if (goes_on) {
      if (ahead_ > 0) {
        --ahead_;
      } else {
        advance(t, dt);
      }
    } else if (!start(state, t, dt)) {
      known_ = false;
      switching_->step(state, t, dt);
      solver_warning_ = switching_->solver_warning();
      return;
    }
    write(instants_[index_behind(ahead_)], state);
    last_.ended(state, t + dt, dt);
    if (ahead_ == 0) choose_new_frames(t, dt);
  }

  std::string solver_warning() const override { return solver_warning_; }
  void archive_state(StateArchive& archive) override {
    archive(last_, frames_, instants_, newest_, known_, ahead_, scratch_, solver_warning_);
    switching_->archive_state(archive);
  }

 private:
  using BodiesAt = std::vector<Instant>;

  std::size_t index_behind(int steps) const { return (newest_ + kNodes - steps) % kNodes; }

  // The first four instants. False if a timed force begins or ends among them.
  bool start(BodyColumns state, double t, double dt) {
    const double end = t + (kNodes - 1) * dt;
    if (parts_.system.loads.next_switch(t, end) < end) return false;
    scratch_ = state;  // the fixed bodies stay there
    for (std::size_t i = 0; i < state.size(); ++i) set_frame(i, state.position(i), state.orientation(i));
    linearise(state, t, dt, [](std::size_t) { return true; });
    for (BodiesAt& instant : instants_) {
      for (std::size_t i = 0; i < state.size(); ++i) instant[i].u = read(state, i);
    }
    evaluate(instants_[0], t, dt);
    for (int n = 1; n < kNodes; ++n) instants_[n] = instants_[0];
    // Each round gains an order; one more for the last digits of a small rest.
    constexpr int kRounds = kNodes + 1;
    for (int round = 0; round < kRounds; ++round) {
      for (int n = 0; n + 1 < kNodes; ++n) {
        for (std::size_t i = 0; i < state.size(); ++i) {
          const Frame& frame = frames_[i];
          Vec12 next = frame.exponential * instants_[n][i].u;
          for (int j = 0; j < kNodes; ++j) next += frame.starting[n][j] * instants_[j][i].rest;
          instants_[n + 1][i].u = next;
        }
      }
      for (int n = 1; n < kNodes; ++n) evaluate(instants_[n], t, dt);
    }
    newest_ = kNodes - 1, known_ = true, ahead_ = kNodes - 2;
    return true;
  }

  void advance(double t, double dt) {
    const std::size_t next = index_behind(-1);
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const Frame& frame = frames_[i];
      Vec12 u = frame.exponential * instants_[newest_][i].u;
      for (int j = 0; j < kNodes; ++j) u += frame.behind[j] * instants_[index_behind(j)][i].rest;
      instants_[next][i].u = u;
    }
    newest_ = next;
    evaluate(instants_[newest_], t, dt);
  }

  // The wrenches at an instant, with the timed forces of the step [t, t + dt], and g there.
  void evaluate(BodiesAt& instant, double t, double dt) {
    write(instant, scratch_.columns());
    parts_.system.wrenches(scratch_.columns(), t, dt, wrenches_);
    for (std::size_t i = 0; i < instant.size(); ++i) {
      instant[i].wrench = wrenches_[i];
      instant[i].rest = rest_of(i, instant[i], scratch_.columns().angular_velocity(i));
    }
  }

  Vec12 rest_of(std::size_t i, const Instant& at, const Vec3& w) const {
    const Inertia& body = parts_.system.bodies[i];
    if (body.fixed) return Vec12::Zero();
    Vec12 rate;
    rate << at.u.segment<3>(6), rate_of_rotation_vector(at.u.segment<3>(3), w), body.inverse_mass * at.wrench.force,
        frames_[i].inverse_inertia_W * at.wrench.torque;
    return rate - frames_[i].linear * at.u;
  }

  Vec12 read(BodyColumns state, std::size_t i) const {
    constexpr double kRounding = 1e-15;  // rad
    const Frame& frame = frames_[i];
    const Vec3 phi = rotation_vector_of((state.orientation(i) * frame.orientation.conjugate()).normalized());
    Vec3 e = state.angular_velocity(i);  // at the frame's own orientation, where J is the inertia
    if (phi.norm() > kRounding)
      e = frame.inverse_inertia_W * angular_momentum_of(parts_.system.bodies[i], state.rotation(i), e);
    Vec12 u;
    u << state.position(i) - frame.position, phi, state.velocity(i), e;
    return u;
  }

  void write(const BodiesAt& instant, MutableBodyColumns state) const {
    for (std::size_t i = 0; i < instant.size(); ++i) {
      const Inertia& body = parts_.system.bodies[i];
      if (body.fixed) continue;
      const Frame& frame = frames_[i];
      const Vec12& u = instant[i].u;
      const Quat q = (rotation_by(u.segment<3>(3)) * frame.orientation).normalized();
      state.set_position(i, frame.position + u.head<3>());
      state.set_orientation(i, q);
      state.set_velocity(i, u.segment<3>(6));
      state.set_angular_velocity(i, angular_velocity_of(body, matrix_of(q), frame.inertia_W * u.tail<3>()));
    }
  }

  void set_frame(std::size_t i, const Vec3& position, const Quat& orientation) {
    Frame& frame = frames_[i];
    const Inertia& body = parts_.system.bodies[i];
    frame.position = position;
    frame.orientation = orientation.normalized();
    const Mat3 R = matrix_of(frame.orientation);
    frame.inertia_W = R * body.inertia_B * R.transpose();
    frame.inverse_inertia_W = R * body.inverse_inertia_B * R.transpose();
  }

  // A and its functions, for the bodies that are asked for and are now where `state` says.
  void linearise(BodyColumns state, double t, double dt, const auto& is_asked_for) {
    std::vector<Mat6> by_pose(state.size(), Mat6::Zero()), by_velocity = by_pose;
    visit_load_jacobian(parts_.system.loads, state, t, dt, [&](const WrenchDerivative& d) {
      if (d.row == d.column) by_pose[d.row] += d.by_pose, by_velocity[d.row] += d.by_velocity;
    });
    for (std::size_t i = 0; i < state.size(); ++i) {
      const Inertia& body = parts_.system.bodies[i];
      if (body.fixed || !is_asked_for(i)) continue;
      Frame& frame = frames_[i];
      Mat6 inverse = Mat6::Zero();
      inverse.topLeftCorner<3, 3>() = body.inverse_mass * Mat3::Identity();
      inverse.bottomRightCorner<3, 3>() = frame.inverse_inertia_W;
      frame.linear.topRightCorner<6, 6>() = Mat6::Identity();
      frame.linear.bottomLeftCorner<6, 6>() = inverse * by_pose[i];
      frame.linear.bottomRightCorner<6, 6>() = inverse * by_velocity[i];
      // Lengths counted in units that make both halves of an oscillation as large, for the sake of the norm.
      const double squared = frame.linear.bottomLeftCorner<6, 6>().cwiseAbs().rowwise().sum().maxCoeff();
      const double unit = squared > 0 ? std::sqrt(squared) : 1;
      Mat12 scaled = dt * frame.linear;
      scaled.topRightCorner<6, 6>() *= unit;
      scaled.bottomLeftCorner<6, 6>() /= unit;
      PhiFunctions phi = phi_functions(scaled);
      for (Mat12& m : phi) m.topRightCorner<6, 6>() /= unit, m.bottomLeftCorner<6, 6>() *= unit;
      frame.exponential = phi[0];
      frame.behind = weights_of(phi, kBehind, dt);
      for (int n = 0; n + 1 < kNodes; ++n) frame.starting[n] = weights_of(phi, {-n, 1 - n, 2 - n, 3 - n}, dt);
    }
  }

  // Chooses new frames for bodies that turned far from theirs in the step [t, t + dt], and converts the history to
  // them.
  void choose_new_frames(double t, double dt) {
    constexpr double kFarthest = 1;  // rad
    const auto is_far = [&](std::size_t i) { return instants_[newest_][i].u.segment<3>(3).norm() > kFarthest; };
    std::vector<bool> far(frames_.size());
    bool any = false;
    for (std::size_t i = 0; i < frames_.size(); ++i) any |= far[i] = is_far(i);
    if (!any) return;
    std::array<BodyTable, kNodes> motions;
    for (int n = 0; n < kNodes; ++n) {
      motions[n] = scratch_;
      write(instants_[n], motions[n].columns());
    }
    const BodyColumns now = motions[newest_].columns();
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      if (far[i]) set_frame(i, now.position(i), now.orientation(i));
    }
    linearise(now, t, dt, [&](std::size_t i) { return far[i]; });
    for (int n = 0; n < kNodes; ++n) {
      for (std::size_t i = 0; i < frames_.size(); ++i) {
        if (!far[i]) continue;
        Instant& at = instants_[n][i];
        at.u = read(motions[n].columns(), i);
        at.rest = rest_of(i, at, motions[n].columns().angular_velocity(i));
      }
    }
  }

  StepperParts parts_;
  Continuation last_;
  std::vector<Frame> frames_;
  std::array<BodiesAt, kNodes> instants_;  // a ring
  std::size_t newest_ = 0;
  bool known_ = false;
  int ahead_ = 0;  // instants after the state
  BodyTable scratch_;
  Wrenches wrenches_;
  std::unique_ptr<Stepper> switching_;
  std::string solver_warning_;
};

}  // namespace

extern const Integrator kExponentialAdams;
const Integrator kExponentialAdams = {
    .name = "exponential-adams",
    .summary =
        "exponential Adams-Bashforth; each body's own springs and dampers solved exactly, the rest extrapolated; no "
        "joints, for bringing a state back to them makes the rates it remembers those of another motion",
    .order = kNodes,
    .symplectic = false,
    .leapfrog_stagger = 0,
    .default_orientation = "",
    .takes_contact = false,
    .make = make_stepper<ExponentialAdams>,
};

}  // namespace rigor::inline dynamics
