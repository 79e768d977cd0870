// The motion of jointed bodies in Simbody's coordinates, for the twins of its integrators. q holds one angle or
// displacement along each axis of a joint, a quaternion (w, x, y, z) for a ball, a quaternion and a position for a free
// body. u holds their speeds, with the angular velocity for a quaternion. A joint has two frames, which coincide at t =
// 0: F, fixed in the parent, and M, fixed in the body. u is the velocity of M in F, in F's axes.
//   q' = N(q) u,   M(q) u' = what loads and gyroscopic terms leave
// with u' by the recursion over the tree of Featherstone (Rigid Body Dynamics Algorithms, 2008, ch. 7), as in Simbody.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "adapters/simbody/simbody_mobilizers.h"
#include "core/dynamics/model/system.h"
#include "core/engine/body_table.h"

namespace rigor::inline adapters {

class SimbodyCoordinates {
 public:
  // The scene's joints must close no loop. Both must outlive it.
  SimbodyCoordinates(const Scene& scene, const System& system);

  struct State {
    Eigen::VectorXd q, u;
  };
  State state_of(BodyColumns bodies) const;
  void place(const State& state, MutableBodyColumns bodies);  // fixed bodies stay as they are

  // N(q) u; quaternions need not be of length 1.
  Eigen::VectorXd q_rate(const Eigen::VectorXd& q, const Eigen::VectorXd& u) const;
  // N(q) u' + N' u, of which N' is that of quaternions alone.
  Eigen::VectorXd q_second_rate(const State& state, const Eigen::VectorXd& u_rate) const;
  // u' at the state of the last place(), under wrenches [N, N m; in W, about the centres of mass] on the bodies.
  Eigen::VectorXd u_rate(const Wrenches& wrenches);
  void normalise(Eigen::VectorXd& q) const;

 private:
  using Kind = MobilizerKind;
  using Vec6 = Eigen::Matrix<double, 6, 1>;  // angular part first
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  using Columns6 = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

  struct Node {
    Kind kind;
    std::size_t body;
    int above = -1;                    // the node of the parent, or -1: the world
    Eigen::Index q, u;                 // where its coordinates and speeds begin
    Vec3 p_parent = Vec3::Zero();      // m, F's origin in the parent's frame
    Quat q_parent = Quat::Identity();  // F to the parent's frame
    Vec3 p_body = Vec3::Zero();        // m, M's origin in B
    Quat q_body = Quat::Identity();    // M to B
    int speeds() const;
    int coordinates() const;
    bool has_quaternion() const { return kind == Kind::free || kind == Kind::ball; }
  };
  struct Pose {  // in W
    Vec3 p = Vec3::Zero();
    Mat3 R = Mat3::Identity();
    Quat q = Quat::Identity();
    Vec3 v = Vec3::Zero(), w = Vec3::Zero();
  };
  struct Across {  // from the parent's centre to the body's
    Vec3 arm;      // m, in W
    Columns6 S;    // the contribution of each speed to the body's (w, v)
    Vec6 c;        // and the acceleration without u'
  };

  // The data of a node that gather() leaves for u_rate(): its inertia along its speeds, the inverse, and the force
  // along them.
  struct Solved {
    Columns6 U;
    Eigen::MatrixXd inverse;
    Eigen::VectorXd left;
  };

  void place(const State& state, std::size_t node);
  void gather(const Wrenches& wrenches);
  Mat6 from_above(std::size_t node) const;
  Vec6 bias(std::size_t node, const Wrenches& wrenches) const;

  const System& system_;
  std::vector<Node> nodes_;  // parents first
  std::vector<Pose> poses_;  // by node
  std::vector<Across> across_;
  std::vector<Mat6> inertia_;  // articulated, by node
  std::vector<Vec6> force_, rate_;
  std::vector<Solved> solved_;
  Eigen::Index q_size_ = 0, u_size_ = 0;
};

}  // namespace rigor::inline adapters
