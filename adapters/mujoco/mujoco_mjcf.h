// A scene in MJCF, MuJoCo's own XML. Bodies are called b0, b1, … by their index, their shapes g0, g1, …, joints j0 (and
// j0x, j0y, j0z where a joint has several elements), springs s0, distance joints d0.
//
// MuJoCo's conventions and ours: SI here and there; quaternions (w, x, y, z), body to world; a body's frame is that of
// its parent's child, and we set its origin at the centre of mass as ours; a capsule by its half length along z, a box
// by half edges, a plane by a frame whose z is the normal.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "adapters/common/spanning_tree.h"
#include "adapters/mujoco/mujoco_options.h"
#include "core/engine/engine.h"

namespace rigor::inline adapters {

// Bodies that hang on each other: TinyXML-2, which reads for MuJoCo, nests a hundred elements.
inline constexpr int kDeepestBody = 95;

std::string mjcf_text(const Vec3& v);
std::string mjcf_text(const Quat& q);
// The attributes of a shape that is no compound. A hull and a height field refer to the asset of this name.
std::string mjcf_shape(const Shape& shape, const std::string& asset);
std::string mjcf_pose(const BodyPose& pose);
// The element of that asset; empty for a shape without one.
std::string mjcf_asset(const Shape& shape, const std::string& name);
// mjModel's hfield_data, of all height fields in the order of the bodies. MuJoCo keeps them in single precision.
std::vector<float> mujoco_heights(const Scene& scene);

// Of the part of a body's shape with this number.
std::string mjcf_geom_name(int body, int part);

// The elements of the joint between a body and its parent, with MuJoCo's types "ball", "hinge" and "slide". The first
// of several moves with the parent. A fixed joint has none.
struct MjcfJoint {
  const char* type;
  std::optional<Vec3> point;  // m, in W; absent: the body's centre
  std::optional<Vec3> axis;   // in W; absent for a ball
  int coordinate = -1;        // the joint of the scene whose coordinate it is, or -1
};
std::vector<MjcfJoint> mjcf_joints(const Scene& scene, int joint, int hanging_body);

// A coupling of elements' coordinates: first = constant + the sum of ratio times each other one. Of two it is an
// equality of joints, of more an equality of a fixed tendon.
struct MjcfCoupling {
  struct Term {
    std::string element;
    double ratio;
  };
  std::string first;
  std::vector<Term> others;
  double constant;

  std::string tendon(std::size_t number) const;    // "" where it needs none
  std::string equality(std::size_t number) const;  // `number`: among all couplings
};
// Those of the scene's couplings and screws; `name_of(joint, element)` names an element, and `sign_of(joint)` is -1
// where an element counts against the scene's coordinate.
using MjcfElementName = std::function<std::string(int joint, std::size_t element)>;
std::vector<MjcfCoupling> mjcf_couplings(const Scene& scene, const SpanningTree& tree, const MjcfElementName& name_of,
                                         const std::function<double(int joint)>& sign_of);
// Whether the scene's joint closes a loop, or is the axis of one that does; whether a coupling has such a joint.
bool closes_loop(const Scene& scene, const SpanningTree& tree, int joint);
bool is_of_a_loop(const Scene& scene, const SpanningTree& tree, const Coupling& coupling);
// The body that hangs on its parent by this joint or by its compound joint; kWorld if it closes a loop.
int body_on(const Scene& scene, const SpanningTree& tree, int joint);

// The Coulomb friction of a joint's coordinate, N m or N.
double mjcf_frictionloss(const Scene& scene, int joint);

// The equality that closes a loop. A hinge is two points on its axis, a metre apart: of their six rows five count.
struct MjcfLoop {
  enum class Equality { connect, tendon, weld, none } equality;
  std::vector<Vec3> points = {};  // m, in W: of `connect`
};
MjcfLoop mjcf_loop(const Joint& joint);

std::string mujoco_mjcf(const Scene& scene, const SpanningTree& tree, const Settings& settings,
                        const MujocoVersion& version);

}  // namespace rigor::inline adapters
