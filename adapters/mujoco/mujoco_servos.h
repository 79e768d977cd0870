// The option servo=native: servos as actuators of MuJoCo, which have the effort kp (target - x) + kd (target_speed -
// x') at each of its evaluations. `rk4` sees them at each stage, and `implicit` solves for their damping. They count
// whole turns.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/engine/engine.h"

namespace rigor::inline adapters {

bool has_native_servos(const Scene& scene, const Settings& settings);

// The elements of MJCF, and the tendons of servos on several joints. `joint_name` names the element of a joint's
// coordinate and `sign_of` is -1 where it counts against the scene's coordinate. Throws EngineFailure for a servo that
// samples, begins late or ends.
std::string mjcf_actuators(const Scene& scene, const std::function<std::string(int joint)>& joint_name,
                           const std::function<double(int joint)>& sign_of);

std::string mjcf_servo_tendons(const Scene& scene, const std::function<std::string(int joint)>& joint_name,
                               const std::function<double(int joint)>& sign_of);

// mjData's ctrl at this time, in the order of the elements.
std::vector<double> mujoco_controls(const std::vector<Motor>& servos, double t);

}  // namespace rigor::inline adapters
