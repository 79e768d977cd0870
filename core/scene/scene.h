// A scene as plain data, independent of any engine. SI units; world frame W, body frame B with its origin at the centre
// of mass. The reader (scene_reader.h) has checked every value before an engine sees it.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/math.h"
#include "core/scene/body_pose.h"
#include "core/scene/drives.h"
#include "core/scene/joint_types.h"
#include "core/scene/shape_types.h"

namespace rigor::inline scene {

inline constexpr int kWorld = -1;  // stands where a body's index would: the world itself, its points in W
inline constexpr double kInfiniteFriction = std::numeric_limits<double>::infinity();

struct Body {
  std::string name;
  double mass = 1;                       // kg; of no meaning if fixed
  Mat3 inertia = Mat3::Identity();       // kg m², about the centre of mass, in B; of no meaning if fixed
  Vec3 position = Vec3::Zero();          // m, p_WB
  Quat orientation = Quat::Identity();   // unit, B to W
  Vec3 velocity = Vec3::Zero();          // m/s, in W
  Vec3 angular_velocity = Vec3::Zero();  // rad/s, in W
  std::optional<Shape> shape;            // in B, but for a plane; several, or one that is not centred: a Compound
  bool collides = false;                 // takes part in contact; needs a shape
  bool fixed = false;                    // static; a plane always is
};

// A straight spring and damper between two points. The force on b's point is -((k + q |d - d0|) (d - d0) + c d') along
// the line from a's point to b's; a gets the opposite force.
struct Spring {
  int a = kWorld, b = kWorld;      // body index or kWorld
  Vec3 point_a = Vec3::Zero();     // m, in a's frame
  Vec3 point_b = Vec3::Zero();     // m, in b's frame
  double stiffness = 0;            // N/m
  double damping = 0;              // N s/m
  double rest_length = 0;          // m
  double quadratic_stiffness = 0;  // N/m²: the stiffness that an extension of a metre adds
};

// The law of springs and of joints with a stiffness, at an extension x: the effort that pulls x back [N, N m], its
// slope, and the energy stored [J]. `Row`: a Spring or a Joint.
template <typename Row, typename Real>
Real elastic_effort(const Row& row, const Real& x) {
  return (static_cast<Real>(row.stiffness) + static_cast<Real>(row.quadratic_stiffness) * (x < 0 ? Real(-x) : x)) * x;
}
template <typename Row>
double stiffness_at(const Row& row, double x) {
  return row.stiffness + 2 * row.quadratic_stiffness * (x < 0 ? -x : x);
}
template <typename Row>
double elastic_energy(const Row& row, double x) {
  return (row.stiffness / 2 + row.quadratic_stiffness / 3 * (x < 0 ? -x : x)) * x * x;
}

// A hinge's angle [rad] is that by which b has turned against a about the axis since t = 0: springs take it from -pi to
// pi, limits count whole turns. A slider's displacement [m] is how far b's centre has come along it. Spring, damper and
// limits act on that coordinate x alone:
//   effort on b = -(stiffness + quadratic_stiffness |x - rest|) (x - rest) - damping x',   the opposite on a.
struct Joint {
  int a = kWorld, b = kWorld;
  JointType type;
  std::string name = "";                                    // as motors call it; see Scene::joint_name()
  double stiffness = 0;                                     // N m/rad, N/m
  double damping = 0;                                       // N m s/rad, N s/m
  double rest = 0;                                          // rad, m
  double lower = -std::numeric_limits<double>::infinity();  // rad, m; at most 0
  double upper = std::numeric_limits<double>::infinity();   // rad, m; at least 0
  double restitution = 0;                                   // of its limits, 0..1
  double armature = 0;             // kg m², kg: of its rotor; adds armature x'^2 / 2 of energy
  double quadratic_stiffness = 0;  // N m/rad², N/m²: the stiffness that a unit of extension adds

  bool has_limits() const { return std::isfinite(lower) || std::isfinite(upper); }
};

// coordinate(joint) = the sum of the terms + offset: gears, rack and pinion, mimic joints. Every coordinate is 0 at t =
// 0, so the offset is 0 within rounding. With several terms, hinges have limits less than a turn apart (turn_window.h),
// and the joints' ends are at most so many bodies.
inline constexpr std::size_t kMostCoupledEnds = 4;
struct Coupling {
  int joint = 0;  // of Scene::joints, with a coordinate
  std::vector<JointTerm> to;
  double offset = 0;  // rad, m

  bool joins(int other) const;
};

// Values of a pair of bodies, because engines combine per-body values by different rules.
//
// A point that does not slide resists with up to static_friction * N, and one that slides with friction * N. Impacts
// have the latter.
//
// Rolling friction is a couple of at most rolling_friction * N against the relative angular velocity across the normal,
// where N is the normal force. Torsional friction is the same about the normal.
//
// A stiffness above 0 makes the contact soft: at an overlap x the normal force is max(0, k x + c x'), the law of Kelvin
// and Voigt. The contact ends where the force does.
struct ContactLaw {
  double restitution = 0;         // normal speed after over before, 0..1
  double friction = 0;            // Coulomb's coefficient, >= 0, may be kInfiniteFriction
  bool collides = true;           // false: the two bodies pass through each other
  double static_friction = 0;     // Coulomb's coefficient of points that do not slide; 0: the same as theirs that do
  double rolling_friction = 0;    // m
  double torsional_friction = 0;  // m
  double stiffness = 0;           // N/m; 0: rigid
  double damping = 0;             // N s/m, of a soft contact: k x + c x' (Kelvin and Voigt)
  double dissipation = 0;         // s/m, instead of damping: k x (1 + dissipation x') (Hunt and Crossley)

  bool is_soft() const { return stiffness > 0; }
  bool sticks_better() const { return static_friction > friction; }
  double sticking_friction() const { return sticks_better() ? static_friction : friction; }
  bool resists_turning() const { return rolling_friction > 0 || torsional_friction > 0; }
};
// Of two bodies that pass through each other.
inline constexpr ContactLaw kApart = {0, 0, false};
struct ContactPair {
  int a, b;
  ContactLaw law;
};

// Constant in W while from <= t < until.
struct TimedForce {
  int body;
  Vec3 force = Vec3::Zero();                               // N, in W
  Vec3 torque = Vec3::Zero();                              // N m, in W
  Vec3 point = Vec3::Zero();                               // m, in B: where the force acts
  double from = 0;                                         // s
  double until = std::numeric_limits<double>::infinity();  // s
};

struct Scene {
  Vec3 gravity = Vec3::Zero();  // m/s²
  std::vector<Body> bodies;
  std::vector<Spring> springs;
  std::vector<Joint> joints;
  std::vector<Coupling> couplings;
  std::vector<Motor> motors;
  std::vector<ContactPair> contact_pairs;
  ContactLaw contact_default;  // for each pair without a row of its own
  std::vector<TimedForce> forces;

  ContactLaw contact_law(int a, int b) const;  // the order of a and b does not matter
  std::string body_name(int index) const { return index == kWorld ? "world" : bodies[index].name; }
  std::string joint_name(std::size_t index) const;        // its own, or "the hinge of 'world' and 'rod'"
  std::string coupling_name(std::size_t index) const;     // "the coupling of joint 'a' to joint 'b'"
  BodyPose pose(int body) const;                          // at t = 0; of the world, W itself
  double extension_at_start(const Spring& spring) const;  // m: of its length beyond the rest length
};

// In the rows that name joints: motors and couplings.
void renumber_joints(Scene& scene, const std::function<int(int)>& number);

// Whether the law of some pair of bodies meets the condition, or that of all other pairs.
template <typename Condition>
bool any_law(const Scene& scene, const Condition& meets) {
  const auto& pairs = scene.contact_pairs;
  return meets(scene.contact_default) ||
         std::any_of(pairs.begin(), pairs.end(), [&](const ContactPair& pair) { return meets(pair.law); });
}

// The word of the joint's type in case files: "hinge".
std::string joint_type_name(const Joint& joint);

// Whether the row stands for an axis of the compound joint before it. It holds nothing together by itself.
bool is_axis_of_compound(const Joint& joint);

// Whether the joint's free coordinate is an angle.
bool turns(const Joint& joint);

// The joint's anchor and its first axis, in W at t = 0. Null for a type that has none.
const Vec3* anchor_of(const Joint& joint);
const Vec3* axis_of(const Joint& joint);

// The axis of the joint's free coordinate, in W at t = 0; null if the joint has none.
const Vec3* free_axis(const Joint& joint);

}  // namespace rigor::inline scene
