#include "adapters/simbody/simbody_coordinates.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "adapters/simbody/simbody_mobilizers.h"

namespace rigor::inline adapters {
namespace {

Quat quaternion_at(const Eigen::VectorXd& q, Eigen::Index first) {
  return {q[first], q[first + 1], q[first + 2], q[first + 3]};
}

Eigen::Vector4d wxyz(const Quat& q) { return {q.w(), q.x(), q.y(), q.z()}; }

// (0, w) q / 2
Eigen::Vector4d turned_at(const Vec3& w, const Eigen::VectorXd& q, Eigen::Index first) {
  return 0.5 * wxyz(Quat(0, w.x(), w.y(), w.z()) * quaternion_at(q, first));
}

Quat about(const Vec3& axis, double angle) { return rotation_by(angle * axis); }

}  // namespace

int SimbodyCoordinates::Node::speeds() const {
  static constexpr int kSpeeds[] = {6, 3, 2, 1, 1, 2, 0};
  return kSpeeds[static_cast<int>(kind)];
}

int SimbodyCoordinates::Node::coordinates() const { return speeds() + (has_quaternion() ? 1 : 0); }

SimbodyCoordinates::SimbodyCoordinates(const Scene& scene, const System& system) : system_(system) {
  std::vector<int> node_of(scene.bodies.size(), -1);
  for (const Mobilizer& joint : mobilizers_of(scene)) {
    const BodyPose pose = scene.pose(joint.body),
                   above = joint.parent == kWorld ? BodyPose{} : scene.pose(joint.parent);
    Node node{.kind = joint.kind, .body = static_cast<std::size_t>(joint.body), .q = q_size_, .u = u_size_};
    if (joint.parent != kWorld) node.above = node_of[joint.parent];
    if (joint.kind != Kind::free) {
      const Quat to_above = above.orientation.conjugate(), to_body = pose.orientation.conjugate(), axes(joint.axes);
      node.p_parent = to_above * (joint.origin - above.position), node.q_parent = (to_above * axes).normalized();
      node.p_body = to_body * (joint.origin - pose.position), node.q_body = (to_body * axes).normalized();
    }
    q_size_ += node.coordinates(), u_size_ += node.speeds();
    node_of[joint.body] = static_cast<int>(nodes_.size());
    nodes_.push_back(node);
  }
  poses_.resize(nodes_.size()), across_.resize(nodes_.size()), inertia_.resize(nodes_.size());
  force_.resize(nodes_.size()), rate_.resize(nodes_.size()), solved_.resize(nodes_.size());
}

SimbodyCoordinates::State SimbodyCoordinates::state_of(BodyColumns bodies) const {
  State state{Eigen::VectorXd(q_size_), Eigen::VectorXd(u_size_)};
  for (const Node& node : nodes_) {
    const Quat q_B = bodies.orientation(node.body);
    const Vec3 p_B = bodies.position(node.body), w_B = bodies.angular_velocity(node.body),
               v_B = bodies.velocity(node.body);
    if (node.kind == Kind::free) {
      state.q.segment<7>(node.q) << wxyz(q_B), p_B;
      state.u.segment<6>(node.u) << w_B, v_B;
      continue;
    }
    Pose above;
    if (node.above >= 0) {
      const std::size_t i = nodes_[static_cast<std::size_t>(node.above)].body;
      above = {bodies.position(i), bodies.rotation(i), bodies.orientation(i), bodies.velocity(i),
               bodies.angular_velocity(i)};
    }
    const Quat q_F = above.q * node.q_parent, q_FM = q_F.conjugate() * q_B * node.q_body;
    const Vec3 w = q_F.conjugate() * (w_B - above.w);
    const auto angle = [](double sine, double cosine) { return 2 * std::atan2(sine, cosine); };
    const Vec3 line = p_B + q_B * node.p_body - above.p;
    const auto moved = [&]() -> Vec3 {  // M's origin in F
      return q_F.conjugate() * line - node.q_parent.conjugate() * node.p_parent;
    };
    const auto speed = [&]() -> Vec3 {
      return q_F.conjugate() * (v_B + w_B.cross(q_B * node.p_body) - above.v - above.w.cross(line));
    };
    switch (node.kind) {
      case Kind::ball:
        state.q.segment<4>(node.q) = wxyz(q_FM.normalized()), state.u.segment<3>(node.u) = w;
        break;
      case Kind::pin:
        state.q[node.q] = angle(q_FM.z(), q_FM.w()), state.u[node.u] = w.z();
        break;
      case Kind::cylinder:
        state.q.segment<2>(node.q) << angle(q_FM.z(), q_FM.w()), moved().z();
        state.u.segment<2>(node.u) << w.z(), speed().z();
        break;
      case Kind::slider:
        state.q[node.q] = moved().x(), state.u[node.u] = speed().x();
        break;
      case Kind::universal: {  // q_FM = (about x)(about y) = (c1 + s1 i)(c2 + s2 j) = c1 c2 + s1 c2 i + c1 s2 j + s1 s2
                               // k
        const double first = angle(q_FM.x(), q_FM.w());
        const Quat second = about(Vec3::UnitX(), -first) * q_FM;
        const Vec3 y = about(Vec3::UnitX(), first) * Vec3::UnitY();
        state.q.segment<2>(node.q) << first, angle(second.y(), second.w());
        state.u.segment<2>(node.u) << w.x(), y.dot(w);
        break;
      }
      case Kind::free:
      case Kind::weld:
        break;
    }
  }
  return state;
}

void SimbodyCoordinates::place(const State& state, MutableBodyColumns bodies) {
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    place(state, n);
    const Pose& pose = poses_[n];
    bodies.set_body(nodes_[n].body, {pose.p, pose.q, pose.v, pose.w});
  }
}

// The velocity of M in F, then its effect on the body; see Across.
void SimbodyCoordinates::place(const State& state, std::size_t n) {
  const Node& node = nodes_[n];
  const Pose above = node.above < 0 ? Pose{} : poses_[static_cast<std::size_t>(node.above)];
  const auto u = state.u.segment(node.u, node.speeds());
  Columns6 H = Columns6::Zero(6, node.speeds());  // of (w, v) of M in F
  Vec3 turning_bias = Vec3::Zero(), p_FM = Vec3::Zero();
  Quat q_FM = Quat::Identity();
  switch (node.kind) {
    case Kind::free:
      H.setIdentity();
      q_FM = quaternion_at(state.q, node.q).normalized(), p_FM = state.q.segment<3>(node.q + 4);
      break;
    case Kind::ball:
      H.topRows<3>().setIdentity();
      q_FM = quaternion_at(state.q, node.q).normalized();
      break;
    case Kind::pin:
      H(2, 0) = 1;
      q_FM = about(Vec3::UnitZ(), state.q[node.q]);
      break;
    case Kind::cylinder:
      H(2, 0) = 1, H(5, 1) = 1;
      q_FM = about(Vec3::UnitZ(), state.q[node.q]), p_FM.z() = state.q[node.q + 1];
      break;
    case Kind::slider:
      H(3, 0) = 1;
      p_FM.x() = state.q[node.q];
      break;
    case Kind::universal: {
      const Quat first = about(Vec3::UnitX(), state.q[node.q]);
      H(0, 0) = 1, H.col(1).head<3>() = first * Vec3::UnitY();
      q_FM = first * about(Vec3::UnitY(), state.q[node.q + 1]);
      turning_bias = u[0] * u[1] * Vec3::UnitX().cross(H.col(1).head<3>());
      break;
    }
    case Kind::weld:
      break;
  }
  Pose& pose = poses_[n];
  Across& across = across_[n];
  const Quat q_F = above.q * node.q_parent;
  const Mat3 R_F = above.R * matrix_of(node.q_parent);
  pose.q = (q_F * q_FM * node.q_body.conjugate()).normalized();
  pose.R = matrix_of(pose.q);
  const Vec3 to_M = above.R * node.p_parent + R_F * p_FM, from_M = -(pose.R * node.p_body);
  pose.p = above.p + to_M + from_M;
  across.arm = to_M + from_M;
  across.S.resize(6, node.speeds());
  across.S.topRows<3>() = R_F * H.topRows<3>();
  across.S.bottomRows<3>() = R_F * H.bottomRows<3>() - cross_matrix(from_M) * across.S.topRows<3>();
  const Vec3 turning = across.S.topRows<3>() * u, moving = R_F * (H.bottomRows<3>() * u);
  pose.w = above.w + turning;
  pose.v = above.v + above.w.cross(to_M) + moving + pose.w.cross(from_M);
  const Vec3 angular = above.w.cross(turning) + R_F * turning_bias;
  across.c << angular, above.w.cross(above.w.cross(to_M)) + 2 * above.w.cross(moving) + angular.cross(from_M) +
                           pose.w.cross(pose.w.cross(from_M));
}

Eigen::VectorXd SimbodyCoordinates::q_rate(const Eigen::VectorXd& q, const Eigen::VectorXd& u) const {
  Eigen::VectorXd rate(q_size_);
  for (const Node& node : nodes_) {
    if (node.has_quaternion()) rate.segment<4>(node.q) = turned_at(u.segment<3>(node.u), q, node.q);
    const int past_q = node.has_quaternion() ? 4 : 0, past_u = node.has_quaternion() ? 3 : 0;
    rate.segment(node.q + past_q, node.coordinates() - past_q) = u.segment(node.u + past_u, node.speeds() - past_u);
  }
  return rate;
}

Eigen::VectorXd SimbodyCoordinates::q_second_rate(const State& state, const Eigen::VectorXd& u_rate) const {
  const Eigen::VectorXd first = q_rate(state.q, state.u);
  Eigen::VectorXd second = q_rate(state.q, u_rate);
  for (const Node& node : nodes_) {
    if (node.has_quaternion()) second.segment<4>(node.q) += turned_at(state.u.segment<3>(node.u), first, node.q);
  }
  return second;
}

SimbodyCoordinates::Vec6 SimbodyCoordinates::bias(std::size_t n, const Wrenches& wrenches) const {
  const Node& node = nodes_[n];
  const Pose& pose = poses_[n];
  const Mat3 inertia = pose.R * system_.bodies[node.body].inertia_B * pose.R.transpose();
  Vec6 bias;
  bias << pose.w.cross(inertia * pose.w) - wrenches[node.body].torque, -wrenches[node.body].force;
  return bias;
}

// The inertia and force of what hangs on each body, from the leaves to the roots.
void SimbodyCoordinates::gather(const Wrenches& wrenches) {
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const Inertia& body = system_.bodies[nodes_[n].body];
    inertia_[n].setZero();
    inertia_[n].topLeftCorner<3, 3>() = poses_[n].R * body.inertia_B * poses_[n].R.transpose();
    inertia_[n].bottomRightCorner<3, 3>() = body.mass * Mat3::Identity();
    force_[n] = bias(n, wrenches);
  }
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    const Columns6& S = across_[n].S;
    Solved& of = solved_[n];
    of.U = inertia_[n] * S;
    const Eigen::MatrixXd D = S.transpose() * of.U;
    of.inverse = D.llt().solve(Eigen::MatrixXd::Identity(D.rows(), D.cols()));
    of.left = -(S.transpose() * force_[n]);
    if (nodes_[n].above < 0) continue;
    const Mat6 rest = inertia_[n] - of.U * of.inverse * of.U.transpose(), X = from_above(n);
    const Vec6 pushed = force_[n] + rest * across_[n].c + of.U * (of.inverse * of.left);
    const auto above = static_cast<std::size_t>(nodes_[n].above);
    inertia_[above] += X.transpose() * rest * X;
    force_[above] += X.transpose() * pushed;
  }
}

// (w', v') from the parent's centre to the body's.
SimbodyCoordinates::Mat6 SimbodyCoordinates::from_above(std::size_t n) const {
  Mat6 X = Mat6::Identity();
  X.bottomLeftCorner<3, 3>() = -cross_matrix(across_[n].arm);
  return X;
}

Eigen::VectorXd SimbodyCoordinates::u_rate(const Wrenches& wrenches) {
  gather(wrenches);
  Eigen::VectorXd out(u_size_);
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const Node& node = nodes_[n];
    Vec6 rate = across_[n].c;
    if (node.above >= 0) rate += from_above(n) * rate_[static_cast<std::size_t>(node.above)];
    Eigen::VectorXd left = solved_[n].left;
    left.noalias() -= solved_[n].U.transpose() * rate;
    const Eigen::VectorXd own = solved_[n].inverse * left;
    out.segment(node.u, node.speeds()) = own;
    rate_[n] = rate + across_[n].S * own;
  }
  return out;
}

void SimbodyCoordinates::normalise(Eigen::VectorXd& q) const {
  for (const Node& node : nodes_)
    if (node.has_quaternion()) q.segment<4>(node.q).normalize();
}

}  // namespace rigor::inline adapters
