// The small motions of a scene about its start, as its springs and dampers see them. Joints and couplings are held
// exactly, and rotors turn with their joints.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace rigor::inline analysis {

// A spring, a joint's own spring and damper, or a servo that acts at each instant: a force along one coordinate.
struct ForceElement {
  enum class Kind { spring, hinge, slider } kind = Kind::spring;
  std::string name;       // "the spring of 'world' and 'cube'"; a joint's as Scene::joint_name
  double stiffness = 0;   // N/m, N m/rad
  double damping = 0;     // N s/m, N m s/rad
  bool is_servo = false;  // its stiffness and damping are kp and kd
  double inertia = 0;     // kg, kg m²: force over acceleration of the coordinate, all other coordinates free
  double damping_rate() const { return damping / inertia; }  // 1/s
};

// A damped oscillator x'' = -rate x' - frequency² x.
struct Oscillator {
  double frequency = 0;  // rad/s, undamped
  double rate = 0;       // 1/s, c/m
};

class SmallMotions {
 public:
  // Nothing for a scene without such elements, or with too many for dense algebra.
  static std::optional<SmallMotions> of(const Scene& scene);

  const std::vector<ForceElement>& elements() const { return elements_; }
  // The mode with the highest frequency, its damping by Rayleigh's quotient.
  const Oscillator& stiffest() const { return stiffest_; }
  // The element that stands for that mode: the one with the most stiffness over inertia.
  const ForceElement& stiffest_element() const;
  // The element with the highest damping rate, servos apart; null if nothing damps.
  const ForceElement* most_damped() const;
  // The servo that limits a semi-implicit step most; null without servos.
  const ForceElement* stiffest_servo() const;
  // The element alone, all other coordinates free.
  static Oscillator alone(const ForceElement& element);

 private:
  void find_stiffest(const Eigen::MatrixXd& response);

  std::vector<ForceElement> elements_;
  Oscillator stiffest_;
};

// The largest dt [s] at which a semi-implicit Euler step keeps the oscillator bounded: (frequency dt)² + 2 rate dt < 4.
double largest_semi_implicit_step(const Oscillator& oscillator);

}  // namespace rigor::inline analysis
