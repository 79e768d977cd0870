// Contact constraints with Newton's law of restitution and Coulomb's law of friction at several points. The impulses
// are p >= 0 along the normals and inside the friction discs such that, with u' the resulting relative velocities,
//   0 <= u'_n - target  ⊥  p_n >= 0,    |p_t| <= mu p_n,  with p_t against u'_t on the disc's rim where u'_t is not
//   zero
// (Moreau, Unilateral contact and dry friction in finite freedom dynamics, 1988; Jean, The non-smooth contact dynamics
// method, 1999). Block Gauss–Seidel solves them one point after another (cone_sweeps.h). If it converges slowly,
// Newton's method (cone_newton.h) continues until only rounding changes, or leaps, which are less accurate. Each island
// (islands.h) is solved alone. With joints each impulse acts through them (impulse_responses.h), on all bodies that are
// connected with the two.
#pragma once

#include <optional>
#include <vector>

#include "core/dynamics/joints/impulse_responses.h"

namespace rigor::inline dynamics {

struct ConeConstraint {
  int a = 0, b = 0;                                 // bodies, or the world; the impulse acts on a, its opposite on b
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();  // m, from the centres of mass to the point, in W
  Mat3 frame = Mat3::Identity();                    // columns: the normal from b to a and two tangents, in W
  // Acts as torques about the frame's columns and not as forces at the point: a hinge's limit. The least velocity is
  // then one of turning [rad/s], the impulse an angular one [N m s].
  bool is_couple = false;
  double friction = 0;          // may be kInfiniteFriction
  bool grips = false;           // its slip is stopped however little it is pressed
  double target_velocity = 0;   // m/s, normal, the least allowed afterwards
  Vec3 offset = Vec3::Zero();   // m/s, in the frame: the velocity beyond that of the bodies
  Vec3 impulse = Vec3::Zero();  // N s, in the frame; the velocities already include its value before solving

  Mat3 inverse_mass = Mat3::Zero();   // 1/kg, of the point, in the frame; from prepare()
  double tangent_effective_mass = 0;  // kg, 1 / the larger eigenvalue of its tangential part
  int response = -1;                  // the place of ConeSolver::Response, where impulses act through joints

  // (force, torque about the centre of mass, in W) on a body of a unit impulse along a direction in W: on a (end 0), or
  // its opposite on b (1). The row of the relative velocity.
  Vec6 row(int end, const Vec3& direction) const {
    const Vec3 along = end == 0 ? direction : Vec3(-direction);
    if (is_couple) return joined(Vec3::Zero(), along);
    return joined(along, (end == 0 ? arm_a : arm_b).cross(along));
  }
};

class ConeSweeps;

// Two unit vectors across n and each other.
Mat3 contact_frame(const Vec3& n);

// When the impulses count as found. Relative to the bodies' own speeds at the points and the effect of the impulses,
// because rounding never stops moving.
struct ConeAccuracy {
  double at_rest = 1e-13;
  double near_rest = 1e-9;  // the residual after the last round: points on the verge of sliding may never come closer
  int most_turns = 12;      // of sweeps and Newton's method
  bool by_newton = true;    // where sweeps creep, else by leaps; what either leaves may have more energy than there was
};

class ConeSolver {
 public:
  // `joints`, which may be null, must outlive it.
  explicit ConeSolver(const System& system, const ConeAccuracy& accuracy = {}, Joints* joints = nullptr)
      : system_(system), accuracy_(accuracy), joints_(joints) {
    if (joints_) through_joints_.emplace(system, *joints_);
  }

  // Takes the inertias from `state`.
  void prepare(BodyColumns state, std::vector<ConeConstraint>& points);
  // Sweeps alone, which begin with zero impulses and no restitution, add no energy, finished or not.
  enum class Means { all, sweeps };
  // Changes impulses and with them the velocities of `state`. Returns false if it did not converge.
  bool solve(MutableBodyColumns state, std::vector<ConeConstraint>& points, Means means = Means::all) const;
  // Newton steps so far, of some 20 µs each where ten bodies touch.
  long work() const { return work_; }
  // The number of islands so far.
  long sweeps() const { return sweeps_; }
  // The relative velocity at the point, in its frame.
  static Vec3 velocity_at(const ConeConstraint& point, BodyColumns state);
  // Adds an impulse, in the frame, to the velocities.
  void push(const ConeConstraint& point, const Vec3& impulse, MutableBodyColumns state) const;

  // The change of a body's velocity (v, w) by an impulse at a point, in its frame.
  struct Change {
    int body = kWorld;
    Eigen::Matrix<double, 6, 3> by = Eigen::Matrix<double, 6, 3>::Zero();
  };
  using Response = std::vector<Change>;

 private:
  void find_responses(BodyColumns state, std::vector<ConeConstraint>& points);
  void find_response(ConeConstraint& point);
  bool solve_island(MutableBodyColumns state, std::vector<ConeConstraint>& points, ConeSweeps& sweeps,
                    Means means) const;
  enum class Start { as_given, by_newton };
  bool sweep_until_settled(MutableBodyColumns state, std::vector<ConeConstraint>& points, ConeSweeps& sweeps,
                           Means means, Start start) const;
  double size_of(BodyColumns state, const std::vector<ConeConstraint>& points) const;
  bool take_newton_steps(MutableBodyColumns state, std::vector<ConeConstraint>& points, double tolerance,
                         int& steps) const;

  const System& system_;
  ConeAccuracy accuracy_;
  mutable long work_ = 0, sweeps_ = 0;
  std::vector<Mat3> inverse_inertia_W_;  // 1/(kg m²)
  Joints* joints_;
  std::optional<ImpulseResponses> through_joints_;
  std::vector<Response> responses_;  // of the points that were prepared last, with joints
};

}  // namespace rigor::inline dynamics
