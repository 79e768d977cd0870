#include "adapters/mujoco/mujoco_model.h"

#include <fmt/format.h>

#include <algorithm>

#include "adapters/mujoco/mujoco_mjcf.h"
#include "core/base/eigen_of.h"

namespace rigor {
namespace {

// MuJoCo's compiler diagonalises a full inertia only to a relative 2.5e-8, which rotates a top by 1e-7 rad in a hundred
// steps. The principal moments and axes are therefore set again to rounding.
void set_inertia(mjModel& model, int body, const Mat3& inertia) {
  const SymmetricEigen principal = eigen_of(inertia);
  Mat3 axes = principal.vectors;
  if (axes.determinant() < 0) axes.col(0) = -axes.col(0);
  const Quat q(axes);
  for (int i = 0; i < 3; ++i) model.body_inertia[3 * body + i] = principal.values[i];
  const double wxyz[4] = {q.w(), q.x(), q.y(), q.z()};
  std::copy(wxyz, wxyz + 4, model.body_iquat + 4 * body);
  model.body_sameframe[body] = 0;
}

bool is_diagonal(const Mat3& m) { return m(0, 1) == 0 && m(0, 2) == 0 && m(1, 2) == 0; }

MujocoModel::Coordinate coordinate_of(const mjModel& model, const Scene& scene, const SpanningTree& tree, int joint) {
  const int id = mj_name2id(&model, mjOBJ_JOINT, fmt::format("j{}", joint).c_str());
  if (id < 0 || !free_axis(scene.joints[joint])) return {};
  return {model.jnt_dofadr[id], scene.joints[joint].b == body_on(scene, tree, joint) ? 1.0 : -1.0};
}

}  // namespace

MujocoModel mujoco_model(const Scene& scene, const SpanningTree& tree, const Settings& settings) {
  MujocoModel made;
  made.model = mujoco_library::compile(mujoco_mjcf(scene, tree, settings));
  mjModel& model = *made.model;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const int id = mj_name2id(&model, mjOBJ_BODY, fmt::format("b{}", i).c_str());
    made.body.push_back(id);
    if (!scene.bodies[i].fixed && !is_diagonal(scene.bodies[i].inertia))
      set_inertia(model, id, scene.bodies[i].inertia);
  }
  for (std::size_t k = 0; k < scene.joints.size(); ++k)
    made.coordinate.push_back(coordinate_of(model, scene, tree, static_cast<int>(k)));
  return made;
}

std::vector<double> mujoco_velocities(const Scene& scene, const SpanningTree& tree, const MujocoModel& made) {
  const mjModel& model = *made.model;
  std::vector<double> velocities(static_cast<std::size_t>(model.nv), 0.0);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const int id = made.body[i];
    if (scene.bodies[i].fixed || model.body_dofnum[id] == 0) continue;
    double* out = &velocities[static_cast<std::size_t>(model.body_dofadr[id])];
    if (tree.links[i].joint < 0) {  // velocity in W, angular velocity in B
      const Body& body = scene.bodies[i];
      Eigen::Map<Vec3>{out} = body.velocity;
      Eigen::Map<Vec3>(out + 3) = matrix_of(body.orientation).transpose() * body.angular_velocity;
      continue;
    }
    const std::vector<double> speeds = hanging_speeds(scene, tree, static_cast<int>(i));
    std::copy(speeds.begin(), speeds.end(), out);
  }
  return velocities;
}

}  // namespace rigor
