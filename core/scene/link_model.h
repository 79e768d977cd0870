// A mechanism as the formats of robots describe it: links with any number of shapes anywhere on them, and joints. What
// a reader of such a format makes; cases/import makes a scene of it. SI units; poses, anchors and axes are those in
// which every joint is at its zero.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/scene/left_out.h"
#include "core/scene/scene.h"

namespace rigor::inline scene {

struct LinkInertial {
  double mass = 0;              // kg
  BodyPose pose;                // in W: its origin the centre of mass, its axes those of the inertia
  Mat3 inertia = Mat3::Zero();  // kg m², about the centre of mass, in the pose's axes
};

struct LinkShape {
  Shape shape;                      // a plane as in the scene, in W: `pose` is not used
  BodyPose pose;                    // in W
  ContactLaw surface;               // of this shape; LinkModel::combine makes a pair's
  unsigned type = 1, affinity = 1;  // two shapes may touch if a bit of one's type is in the other's affinity
  std::string where;                // for messages: "file:line: collision 'foot'"
  // Of a contact's force, as MJCF's condim counts them: 1 has no friction, 3 has sliding friction, 4 torsional and 6
  // also rolling friction. The larger number of two shapes counts.
  int dimensions = 6;
  int priority = 0;  // the surface of the greater one counts alone
};

struct Link {
  std::string name, where;                  // where: "file:line: link 'arm'"
  BodyPose pose;                            // in W
  std::vector<LinkInertial> inertial = {};  // one, or none
  std::vector<LinkShape> shapes = {};
  bool is_static = false;          // part of the world
  int model = 0;                   // links of one model
  bool touches_own_model = false;  // may touch other links of it, but those it is joined to
  double lifted = 0;               // share of its weight that a constant force carries; 1: gravity does not act on it
  Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();  // m/s, of the pose's origin; rad/s; in W
};

struct LinkJoint {
  Joint joint;       // a and b: links, or kWorld; anchor and axes in W
  double start = 0;  // rad, m: where it is at t = 0; a scene's joint counts from there
  std::string where = "";
  double friction = 0;     // N m, N: Coulomb friction on the free axis
  double armature = 0;     // kg m², kg: inertia of the rotor, added on the axis
  bool is_driven = false;  // a motor or a coupling names it
  bool is_loop = false;    // closes a loop beside the tree: its links may touch each other
};

// coordinate(joint) = the sum of the terms + offset, all counted from the file's zeros.
struct LinkCoupling {
  int joint;                  // of LinkModel::joints, as those of the terms
  std::vector<JointTerm> to;  // at least one
  double offset = 0;
  std::string where = "";
};

// Gives a coupling or a motor the new places of its joints, by joint. False if one of them has none (-1).
inline bool renumber(int& joint, std::vector<JointTerm>& terms, const std::vector<int>& place) {
  joint = place[static_cast<std::size_t>(joint)];
  for (JointTerm& term : terms) term.joint = place[static_cast<std::size_t>(term.joint)];
  return joint >= 0 && std::all_of(terms.begin(), terms.end(), [](const JointTerm& term) { return term.joint >= 0; });
}
inline bool renumber(LinkCoupling& row, const std::vector<int>& place) { return renumber(row.joint, row.to, place); }
inline bool renumber(Motor& motor, const std::vector<int>& place) { return renumber(motor.joint, motor.plus, place); }
// Leaves out the rows of which it is false.
template <typename Row>
void keep_renumbered(std::vector<Row>& rows, const std::vector<int>& place) {
  std::vector<Row> kept;
  for (Row& row : rows)
    if (renumber(row, place)) kept.push_back(std::move(row));
  rows = std::move(kept);
}

struct LinkModel {
  std::string name;
  Vec3 gravity = Vec3::Zero();  // m/s²
  std::vector<Link> links;
  std::vector<LinkJoint> joints;
  std::vector<Spring> springs;  // a and b: links; points in their frames
  std::vector<Motor> motors;    // joint: of `joints`
  std::vector<LinkCoupling> couplings;
  std::vector<std::pair<int, int>> kept_apart;  // links that never touch, beside those that a joint holds together
  bool has_state = false;                       // somebody chose where each joint starts
  bool keeps_overlaps_apart = false;            // the file does not say which links touch
  double (*combine)(double, double) = nullptr;  // of two surfaces' friction, and of their restitution
  LeftOut left_out;
};

}  // namespace rigor::inline scene
