#include "core/scene/joint_traits.h"

#include <algorithm>
#include <numeric>

namespace rigor::inline scene {
namespace {

// Bodies that joints connect, as trees of which each knows its root. The world, and with it every fixed body, is the
// last one.
class ConnectedBodies {
 public:
  explicit ConnectedBodies(const Scene& scene) : scene_(scene), parent_(scene.bodies.size() + 1) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  // False if they are connected already.
  bool connect(int a, int b) {
    const std::size_t one = root_of(a), other = root_of(b);
    parent_[one] = other;
    return one != other;
  }

 private:
  std::size_t root_of(int body) {
    const bool stands = body == kWorld || scene_.bodies[static_cast<std::size_t>(body)].fixed;
    std::size_t i = stands ? scene_.bodies.size() : static_cast<std::size_t>(body);
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  const Scene& scene_;
  std::vector<std::size_t> parent_;
};

bool keep_two_speeds(const Motor& one, const Motor& other) {
  return one.speed && other.speed && one.joint == other.joint && one.from < other.until && other.from < one.until;
}

}  // namespace

std::vector<Need> joint_traits_of(const Scene& scene) {
  std::vector<Need> traits;
  ConnectedBodies connected(scene);
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    if (is_axis_of_compound(scene.joints[k]) || connected.connect(scene.joints[k].a, scene.joints[k].b)) continue;
    traits.push_back({Feature::joint_loop, scene.joint_name(k)});
    break;
  }
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    if (!scene.joints[k].has_limits() || scene.joints[k].restitution == 0) continue;
    traits.push_back({Feature::joint_limit_that_bounces, scene.joint_name(k)});
    break;
  }
  const auto drives_limited_joint = [&](const Motor& motor) {
    return motor.speed && scene.joints[static_cast<std::size_t>(motor.joint)].has_limits();
  };
  const auto motor = std::find_if(scene.motors.begin(), scene.motors.end(), drives_limited_joint);
  if (motor != scene.motors.end())
    traits.push_back({Feature::speed_motor_with_limits, scene.joint_name(static_cast<std::size_t>(motor->joint))});
  for (auto one = scene.motors.begin(); one != scene.motors.end(); ++one) {
    if (std::none_of(scene.motors.begin(), one, [&](const Motor& other) { return keep_two_speeds(*one, other); }))
      continue;
    traits.push_back({Feature::two_speeds_at_once, scene.joint_name(static_cast<std::size_t>(one->joint))});
    break;
  }
  return traits;
}

}  // namespace rigor::inline scene
