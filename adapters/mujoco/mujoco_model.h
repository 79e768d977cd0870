// A scene as a model of MuJoCo: its text in MJCF, and values that the text cannot hold with all digits.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adapters/common/spanning_tree.h"
#include "adapters/mujoco/mujoco_library.h"
#include "core/engine/engine.h"

namespace rigor::inline adapters {

struct MujocoModel {
  mujoco_library::Model model;
  std::vector<int> body;  // by body of the scene: MuJoCo's, or -1 for a fixed one without one
  // One per joint of the scene: the place of its coordinate in qvel, or -1 without a coordinate of its own, and the
  // sign 1 or -1. MuJoCo counts from parent to child, so the coordinate is MuJoCo's or its negative.
  struct Coordinate {
    int velocity = -1;
    double sign = 1;
  };
  std::vector<Coordinate> coordinate;
};

// Throws InputError with MuJoCo's words where it refuses the scene.
MujocoModel mujoco_model(const Scene& scene, const SpanningTree& tree, const Settings& settings);

// MuJoCo's compiler diagonalises a full inertia only to a relative 2.5e-8, which rotates a top by 1e-7 rad in a hundred
// steps. The principal moments and axes are therefore set again to rounding. None for a diagonal inertia.
struct MujocoInertia {
  Vec3 moments;  // kg m²
  Quat axes;     // to B
};
std::optional<MujocoInertia> inertia_to_set(const Body& body);

// The speeds of a body's joint at t = 0, in the order of MuJoCo's. A free body: its velocity in W, and its angular
// velocity in B. Empty for a fixed body.
std::vector<double> mujoco_speeds(const Scene& scene, const SpanningTree& tree, int body);

// The velocities of all joints and free bodies at t = 0, for qvel.
std::vector<double> mujoco_velocities(const Scene& scene, const SpanningTree& tree, const MujocoModel& model);

}  // namespace rigor::inline adapters
