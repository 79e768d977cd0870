#include "adapters/mujoco/mujoco_model.h"

#include <fmt/format.h>

#include <algorithm>

#include "adapters/mujoco/mujoco_mjcf.h"
#include "adapters/mujoco/mujoco_options.h"
#include "core/base/eigen_of.h"

namespace rigor::inline adapters {
namespace {

void set_inertia(mjModel& model, int body, const MujocoInertia& inertia) {
  std::copy(inertia.moments.begin(), inertia.moments.end(), model.body_inertia + 3 * body);
  const Quat& q = inertia.axes;
  const double wxyz[4] = {q.w(), q.x(), q.y(), q.z()};
  std::copy(wxyz, wxyz + 4, model.body_iquat + 4 * body);
  model.body_sameframe[body] = 0;
}

MujocoModel::Coordinate coordinate_of(const mjModel& model, const Scene& scene, const SpanningTree& tree, int joint) {
  const int id = mj_name2id(&model, mjOBJ_JOINT, fmt::format("j{}", joint).c_str());
  if (id < 0 || !free_axis(scene.joints[joint])) return {};
  return {model.jnt_dofadr[id], scene.joints[joint].b == body_on(scene, tree, joint) ? 1.0 : -1.0};
}

}  // namespace

std::optional<MujocoInertia> inertia_to_set(const Body& body) {
  const Mat3& m = body.inertia;
  if (body.fixed || (m(0, 1) == 0 && m(0, 2) == 0 && m(1, 2) == 0)) return std::nullopt;
  const SymmetricEigen principal = eigen_of(m);
  Mat3 axes = principal.vectors;
  if (axes.determinant() < 0) axes.col(0) = -axes.col(0);
  return MujocoInertia{principal.values, Quat(axes)};
}

MujocoModel mujoco_model(const Scene& scene, const SpanningTree& tree, const Settings& settings) {
  MujocoModel made;
  made.model = mujoco_library::compile(mujoco_mjcf(scene, tree, settings, kMujoco2));
  mjModel& model = *made.model;
  const std::vector<float> heights = mujoco_heights(scene);
  std::copy(heights.begin(), heights.end(), model.hfield_data);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const int id = mj_name2id(&model, mjOBJ_BODY, fmt::format("b{}", i).c_str());
    made.body.push_back(id);
    if (const auto inertia = inertia_to_set(scene.bodies[i])) set_inertia(model, id, *inertia);
  }
  for (std::size_t k = 0; k < scene.joints.size(); ++k)
    made.coordinate.push_back(coordinate_of(model, scene, tree, static_cast<int>(k)));
  return made;
}

std::vector<double> mujoco_speeds(const Scene& scene, const SpanningTree& tree, int index) {
  const Body& body = scene.bodies[static_cast<std::size_t>(index)];
  if (body.fixed) return {};
  if (tree.links[static_cast<std::size_t>(index)].joint >= 0) return hanging_speeds(scene, tree, index);
  const Vec3 &v = body.velocity, w = matrix_of(body.orientation).transpose() * body.angular_velocity;
  return {v.x(), v.y(), v.z(), w.x(), w.y(), w.z()};
}

std::vector<double> mujoco_velocities(const Scene& scene, const SpanningTree& tree, const MujocoModel& made) {
  const mjModel& model = *made.model;
  std::vector<double> velocities(static_cast<std::size_t>(model.nv), 0.0);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const int id = made.body[i];
    if (scene.bodies[i].fixed || model.body_dofnum[id] == 0) continue;
    const std::vector<double> speeds = mujoco_speeds(scene, tree, static_cast<int>(i));
    std::copy(speeds.begin(), speeds.end(), velocities.begin() + model.body_dofadr[id]);
  }
  return velocities;
}

}  // namespace rigor::inline adapters
