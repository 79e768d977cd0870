// MuJoCo, double precision. Joints are coordinates of trees of bodies; contacts and loops are soft constraints, whose
// forces minimise one convex function a step (Todorov, Erez, Tassa, "MuJoCo: A physics engine for model-based control",
// 2012). There is no restitution.
#pragma once

#include "core/engine/engine.h"

namespace rigor::inline adapters {

// What a MuJoCo of either version expresses, and its methods.
Features mujoco_features();
std::vector<MethodInfo> mujoco_methods();

class MujocoEngine : public Engine {
 public:
  EngineInfo info() const override;
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override;
  std::string twin(const Settings& settings) const override;
};

}  // namespace rigor::inline adapters
