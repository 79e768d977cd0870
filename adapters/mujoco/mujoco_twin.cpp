// The smooth steps of MuJoCo 2.2, for comparison with MuJoCo itself. A free body's coordinates are position,
// orientation q, velocity in W and angular velocity w in B. tau is the torque in B and I the inertia there:
//   euler     w1 = w0 + dt I⁻¹ (tau - w0 x I w0),   v1 = v0 + dt F/m,   x1 = x0 + dt v1,   q1 = q0 exp(dt w1),
//             and alike in the coordinates of joints (adapters/common/reduced_twin.h); the others for free bodies alone
//   implicit  the same with (I + dt ([w0]x I - [I w0]x))⁻¹ for I⁻¹ and, where springs damp, one Newton step for their
//             forces: (M + dt sum c j jᵀ) (V1 - V0) = dt f, j the slope of a spring's length in the velocities of one
//             body; the effect of one body's velocity on another's force is left out
//   rk4       the classical stages of (x, q, v, w), but q_s = q0 exp(c_s dt w) of the stage before and
//             q1 = q0 exp(dt sum b_s w_s), which leaves out that turns do not commute: order 2
// Springs are evaluated at each stage; timed forces are wrenches that are held over the step.
#include "adapters/mujoco/mujoco_twin.h"

#include <Eigen/LU>
#include <array>

#include "adapters/common/reduced_twin.h"

namespace rigor::inline adapters {
namespace {

// A body's angular velocity in B from the state's, which is in W, and back.
Vec3 in_body(BodyColumns state, std::size_t i) { return state.rotation(i).transpose() * state.angular_velocity(i); }

void turn(MutableBodyColumns state, std::size_t i, const Quat& from, const Vec3& angle, const Vec3& w_B) {
  state.set_orientation(i, (from * rotation_by(angle)).normalized());
  state.set_angular_velocity(i, state.rotation(i) * w_B);
}

struct Rates {
  Vec3 v, w_B;            // m/s, in W; rad/s, in B
  Vec3 acceleration, dw;  // m/s², in W; rad/s², in B
};

Rates rates_of(const Inertia& body, BodyColumns state, std::size_t i, const Wrench& wrench) {
  const Vec3 w = in_body(state, i), torque = state.rotation(i).transpose() * wrench.torque;
  return {state.velocity(i), w, body.inverse_mass * wrench.force,
          body.inverse_inertia_B * (torque - w.cross(body.inertia_B * w))};
}

class ImplicitTwin : public Stepper {
 public:
  explicit ImplicitTwin(const StepperParts& parts) : system_(parts.system) {}

  void step(MutableBodyColumns state, double t, double dt) override {
    system_.wrenches(state, t, dt, wrenches_);
    slopes_.assign(state.size(), Slope::Identity());
    for (std::size_t i = 0; i < state.size(); ++i) set_body(state, i, dt);
    for (const Spring& spring : system_.loads.springs()) {
      if (spring.damping > 0) add_damper(state, spring, dt);
    }
    for (std::size_t i = 0; i < state.size(); ++i) {
      if (!system_.bodies[i].fixed) advance(state, i, dt);
    }
  }
  void archive_state(StateArchive&) override {}  // nothing outlives a step

 private:
  using Slope = Eigen::Matrix<double, 6, 6>;  // of the forces, in a body's velocity in W and angular velocity in B

  void set_body(BodyColumns state, std::size_t i, double dt) {
    const Inertia& body = system_.bodies[i];
    const Vec3 w = in_body(state, i);
    slopes_[i].topLeftCorner<3, 3>() *= body.mass;
    slopes_[i].bottomRightCorner<3, 3>() =
        body.inertia_B + dt * (cross_matrix(w) * body.inertia_B - cross_matrix(body.inertia_B * w));
  }

  void add_damper(BodyColumns state, const Spring& spring, double dt) {
    const PointMotion a = point_motion(state, spring.a, spring.point_a),
                      b = point_motion(state, spring.b, spring.point_b);
    const Vec3 line = (b.position - a.position).normalized();
    for (const auto& [body, arm] : {std::pair(spring.a, a.arm), std::pair(spring.b, b.arm)}) {
      if (body == kWorld) continue;
      const auto i = static_cast<std::size_t>(body);
      Eigen::Matrix<double, 6, 1> j;
      j << line, state.rotation(i).transpose() * arm.cross(line);
      slopes_[i] += dt * spring.damping * j * j.transpose();
    }
  }

  void advance(MutableBodyColumns state, std::size_t i, double dt) const {
    const Inertia& body = system_.bodies[i];
    const Vec3 w = in_body(state, i), torque = state.rotation(i).transpose() * wrenches_[i].torque;
    Eigen::Matrix<double, 6, 1> impulse;
    impulse << dt * wrenches_[i].force, dt * (torque - w.cross(body.inertia_B * w));
    const Eigen::Matrix<double, 6, 1> change = slopes_[i].partialPivLu().solve(impulse);
    const Vec3 v = state.velocity(i) + change.head<3>(), w_end = w + change.tail<3>();
    state.set_velocity(i, v);
    state.set_position(i, state.position(i) + dt * v);
    turn(state, i, state.orientation(i), dt * w_end, w_end);
  }

  const System& system_;
  Wrenches wrenches_;
  std::vector<Slope> slopes_;  // by body
};

class Rk4Twin : public Stepper {
 public:
  explicit Rk4Twin(const StepperParts& parts) : system_(parts.system) {}

  void step(MutableBodyColumns state, double t, double dt) override {
    static constexpr std::array kNodes = {0.0, 0.5, 0.5, 1.0}, kWeights = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    start_ = BodyColumns(state);
    sums_.assign(state.size(), {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()});
    for (std::size_t stage = 0; stage < kNodes.size(); ++stage) {
      if (stage > 0) advance(state, rates_, kNodes[stage] * dt);
      evaluate(state, t, dt);
      for (std::size_t i = 0; i < state.size(); ++i) add(sums_[i], rates_[i], kWeights[stage]);
    }
    advance(state, sums_, dt);
  }
  void archive_state(StateArchive&) override {}  // nothing outlives a step

 private:
  static void add(Rates& sum, const Rates& rates, double weight) {
    sum.v += weight * rates.v, sum.w_B += weight * rates.w_B;
    sum.acceleration += weight * rates.acceleration, sum.dw += weight * rates.dw;
  }

  // A timed force turns with its body no further than it had at the step's start.
  void evaluate(BodyColumns state, double t, double dt) {
    system_.wrenches(state, t, dt, wrenches_);
    add_timed_forces(state, t, dt, -1), add_timed_forces(start_.columns(), t, dt, 1);
    rates_.clear();
    for (std::size_t i = 0; i < state.size(); ++i)
      rates_.push_back(rates_of(system_.bodies[i], state, i, wrenches_[i]));
  }

  void add_timed_forces(BodyColumns state, double t, double dt, double sign) {
    system_.loads.for_each_acting(t, dt, [&](const TimedForce& timed, double share) {
      const auto i = static_cast<std::size_t>(timed.body);
      const Vec3 arm = state.rotation(i) * timed.point;
      wrenches_[i].force += sign * share * timed.force;
      wrenches_[i].torque += sign * share * (timed.torque + arm.cross(timed.force));
    });
  }

  // Advances from the step's start over `time` with these rates.
  void advance(MutableBodyColumns state, const std::vector<Rates>& rates, double time) const {
    const BodyColumns start = start_.columns();
    for (std::size_t i = 0; i < state.size(); ++i) {
      if (system_.bodies[i].fixed) continue;
      state.set_position(i, start.position(i) + time * rates[i].v);
      state.set_velocity(i, start.velocity(i) + time * rates[i].acceleration);
      turn(state, i, start.orientation(i), time * rates[i].w_B, in_body(start, i) + time * rates[i].dw);
    }
  }

  const System& system_;
  BodyTable start_;
  Wrenches wrenches_;
  std::vector<Rates> rates_, sums_;
};

constexpr const char* kSummary = "repeats MuJoCo's own smooth step, to explain its error";

}  // namespace

// Dampers of joints are implicit in MuJoCo's Euler, and loops soft constraints: neither is repeated.
const Integrator kMujocoEulerTwin = {
    .name = "mujoco-euler-twin",
    .summary = kSummary,
    .order = 1,
    .symplectic = false,  // the gyroscopic term is explicit
    .leapfrog_stagger = 0.5,
    .default_orientation = "",
    .takes_contact = false,
    .takes_joints = true,
    .lacks = {joint_feature<DistanceJoint>(), Feature::joint_damper, Feature::joint_limit, Feature::joint_loop,
              Feature::joint_friction, Feature::motor_servo, Feature::motor_speed},
    .twin_of = "mujoco",
    .twin_takes = {Feature::armature},
    .make = [](const StepperParts& parts) { return make_reduced_twin(parts, exact_turn); }};

const Integrator kMujocoImplicitTwin = {.name = "mujoco-implicit-twin",
                                        .summary = kSummary,
                                        .order = 1,
                                        .symplectic = false,  // it damps
                                        .leapfrog_stagger = 0.5,
                                        .default_orientation = "",
                                        .takes_contact = false,
                                        .twin_of = "mujoco",
                                        .make = make_stepper<ImplicitTwin>};

const Integrator kMujocoRk4Twin = {.name = "mujoco-rk4-twin",
                                   .summary = kSummary,
                                   .order = 2,
                                   .symplectic = false,
                                   .leapfrog_stagger = 0,
                                   .default_orientation = "",
                                   .takes_contact = false,
                                   .twin_of = "mujoco",
                                   .make = make_stepper<Rk4Twin>};

}  // namespace rigor::inline adapters
