// The equations that the reference solves, for any number type: Newton-Euler under gravity, springs, dampers and timed
// forces. jointed_motion.h adds what joints do. These equations are written apart from core/dynamics on purpose, so
// that a mistake there cannot hide in the truth.
//
// A moving body has 13 numbers: p_WB, q (w, x, y, z), v_W, and then either w_B or L_W:
//   body_rates:  I w' = R^T torque - w x I w,   q' = 1/2 q (0, w_B)
//   momentum:    L' = torque,  w_W = R I^-1 R^T L,   q' = 1/2 (0, w_W) q
// (Goldstein, Classical Mechanics, 3rd ed., sections 4.9 and 5.5). R is the rotation of q / |q|.
#pragma once

#include <vector>

#include "cases/truth/solved/acting_forces.h"
#include "core/engine/body_table.h"
#include "core/scene/scene.h"

namespace rigor::inline truth {

enum class Formulation { body_rates, momentum };

template <typename Real>
class EquationsOfMotion {
 public:
  using State = std::vector<Real>;
  using Vector = Eigen::Matrix<Real, 3, 1>;
  using Matrix = Eigen::Matrix<Real, 3, 3>;

  EquationsOfMotion(const Scene& scene, Formulation formulation) : scene_(scene), formulation_(formulation) {
    for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
      const Body& body = scene.bodies[i];
      slot_.push_back(body.fixed ? -1 : kNumbersPerBody * static_cast<int>(moving_.size()));
      if (!body.fixed) moving_.push_back(i);
      const Matrix inertia = body.inertia.template cast<Real>();
      inertia_.push_back(inertia);
      inverse_inertia_.push_back(body.fixed ? Matrix::Zero().eval() : inertia.inverse().eval());
    }
  }

  State start() const {
    State state(moving_.size() * kNumbersPerBody);
    for (const int i : moving_) {
      const Body& body = scene_.bodies[i];
      Real* s = &state[slot_[i]];
      const Eigen::Matrix<Real, 4, 1> q = Eigen::Matrix<Real, 4, 1>(body.orientation.w(), body.orientation.x(),
                                                                    body.orientation.y(), body.orientation.z())
                                              .normalized();
      const Matrix R = rotation_of(q.data());
      const Vector w_B = R.transpose() * body.angular_velocity.template cast<Real>();
      put(s, body.position.template cast<Real>());
      for (int k = 0; k < 4; ++k) s[3 + k] = q[k];
      put(s + 7, body.velocity.template cast<Real>());
      put(s + 10, formulation_ == Formulation::body_rates ? w_B : Vector(R * (inertia_[i] * w_B)));
    }
    return state;
  }

  class Interval;
  // The right-hand side while the timed forces are those that act at t [s].
  Interval during(double t) const { return {*this, t}; }

  // The bodies of a state, rounded to double; a fixed body stands where the scene puts it.
  template <typename Number>
  void write(const Number* state, MutableBodyColumns out) const {
    for (std::size_t i = 0; i < slot_.size(); ++i) {
      if (slot_[i] < 0) {
        out.set_body(i, {scene_.bodies[i].position, scene_.bodies[i].orientation, Vec3::Zero(), Vec3::Zero()});
        continue;
      }
      Real s[kNumbersPerBody];
      for (int k = 0; k < kNumbersPerBody; ++k) s[k] = static_cast<Real>(state[slot_[i] + k]);
      const Eigen::Matrix<Real, 4, 1> q = Eigen::Map<const Eigen::Matrix<Real, 4, 1>>(s + 3).normalized();
      const Vector w = angular_velocity(s, rotation_of(s + 3), i);
      out.set_position(i, get(s).template cast<double>());
      out.set_orientation(i, Quat(static_cast<double>(q[0]), static_cast<double>(q[1]), static_cast<double>(q[2]),
                                  static_cast<double>(q[3])));
      out.set_velocity(i, get(s + 7).template cast<double>());
      out.set_angular_velocity(i, w.template cast<double>());
    }
  }

  static constexpr int kNumbersPerBody = 13;

  struct Pose {
    Vector position = Vector::Zero(), velocity = Vector::Zero();  // in W
    Vector w = Vector::Zero();                                    // in W
    Matrix R = Matrix::Identity();
    Vector force = Vector::Zero(), torque = Vector::Zero();  // in W, about the centre of mass
  };

  static Vector get(const Real* s) { return {s[0], s[1], s[2]}; }
  static void put(Real* s, const Vector& v) { s[0] = v[0], s[1] = v[1], s[2] = v[2]; }

  const Scene& scene() const { return scene_; }
  const std::vector<int>& moving() const { return moving_; }
  int slot(int body) const { return slot_[body]; }  // -1 if fixed
  const Matrix& inverse_inertia(int body) const { return inverse_inertia_[body]; }

  static Matrix rotation_of(const Real* q) {
    const Real w = q[0], x = q[1], y = q[2], z = q[3], s = 2 / (w * w + x * x + y * y + z * z);
    Matrix R;
    R << 1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),  //
        s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x),   //
        s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y);
    return R;
  }

  Vector angular_velocity(const Real* s, const Matrix& R, std::size_t i) const {
    if (formulation_ == Formulation::body_rates) return R * get(s + 10);
    return R * (inverse_inertia_[i] * (R.transpose() * get(s + 10)));
  }

  // Zero velocity; correct for fixed bodies in any state.
  std::vector<Pose> standing_poses() const {
    std::vector<Pose> poses(slot_.size());
    for (std::size_t i = 0; i < slot_.size(); ++i) {
      const Quat& q = scene_.bodies[i].orientation;
      const Real wxyz[] = {q.w(), q.x(), q.y(), q.z()};
      poses[i].position = scene_.bodies[i].position.template cast<Real>();
      poses[i].R = rotation_of(wxyz);
    }
    return poses;
  }

  void read_poses(const State& state, std::vector<Pose>& poses) const {
    for (const int i : moving_) {
      const Real* s = &state[slot_[i]];
      Pose& pose = poses[i];
      pose.position = get(s), pose.velocity = get(s + 7), pose.R = rotation_of(s + 3);
      pose.w = angular_velocity(s, pose.R, i);
      pose.force.setZero(), pose.torque.setZero();
    }
  }

 private:
  void add_spring(const Spring& spring, std::vector<Pose>& poses) const {
    Pose world;
    Pose& a = spring.a == kWorld ? world : poses[spring.a];
    Pose& b = spring.b == kWorld ? world : poses[spring.b];
    const Vector arm_a = a.R * spring.point_a.template cast<Real>(), arm_b = b.R * spring.point_b.template cast<Real>();
    const Vector line = b.position + arm_b - a.position - arm_a;
    const Real length = line.norm();
    if (length == 0) return;
    const Vector closing = b.velocity + b.w.cross(arm_b) - a.velocity - a.w.cross(arm_a);
    const Real tension = elastic_effort(spring, Real(length - static_cast<Real>(spring.rest_length))) +
                         static_cast<Real>(spring.damping) * line.dot(closing) / length;
    const Vector force = line * (tension / length);  // on a; its opposite on b
    a.force += force, a.torque += arm_a.cross(force);
    b.force -= force, b.torque -= arm_b.cross(force);
  }

  using Acting = std::vector<const TimedForce*>;

  // Numbers of a state behind those of the bodies are not its own.
  void evaluate(const State& state, const Acting& acting, std::vector<Pose>& poses, State& change) const {
    read_poses(state, poses);
    for (const Spring& spring : scene_.springs) add_spring(spring, poses);
    for (const TimedForce* timed : acting) {
      Pose& pose = poses[timed->body];
      const Vector force = timed->force.template cast<Real>(), arm = pose.R * timed->point.template cast<Real>();
      pose.force += force, pose.torque += timed->torque.template cast<Real>() + arm.cross(force);
    }
    change.resize(state.size());
    for (const int i : moving_) change_of_body(i, poses[i], &state[slot_[i]], &change[slot_[i]]);
  }

  void change_of_body(int i, const Pose& pose, const Real* s, Real* change) const {
    const Real half = Real(1) / 2;
    const Vector u = get(s + 4);
    put(change, pose.velocity);
    put(change + 7, scene_.gravity.template cast<Real>() + pose.force / static_cast<Real>(scene_.bodies[i].mass));
    if (formulation_ == Formulation::body_rates) {
      const Vector w_B = get(s + 10);
      change[3] = -half * u.dot(w_B);
      put(change + 4, half * (s[3] * w_B + u.cross(w_B)));
      put(change + 10, inverse_inertia_[i] * (pose.R.transpose() * pose.torque - w_B.cross(inertia_[i] * w_B)));
    } else {
      change[3] = -half * u.dot(pose.w);
      put(change + 4, half * (s[3] * pose.w + pose.w.cross(u)));
      put(change + 10, pose.torque);
    }
  }

  Scene scene_;
  Formulation formulation_;
  std::vector<int> moving_;  // body indices
  std::vector<int> slot_;    // of each body: where its numbers begin in the state; -1 if fixed
  std::vector<Matrix> inertia_, inverse_inertia_;
};

template <typename Real>
class EquationsOfMotion<Real>::Interval {
 public:
  Interval(const EquationsOfMotion& motion, double t)
      : motion_(&motion), acting_(acting_at(motion.scene_, t)), poses_(motion.standing_poses()) {}
  void operator()(const State& state, State& change, Real) { motion_->evaluate(state, acting_, poses_, change); }
  const std::vector<Pose>& poses() const { return poses_; }  // of the state that was evaluated last

 private:
  const EquationsOfMotion* motion_;
  Acting acting_;
  std::vector<Pose> poses_;  // room to work in
};

}  // namespace rigor::inline truth
