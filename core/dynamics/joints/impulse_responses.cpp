#include "core/dynamics/joints/impulse_responses.h"

#include <algorithm>

namespace rigor::inline dynamics {

std::vector<int> ImpulseResponses::moved_by(int a, int b) const {
  std::vector<int> bodies;
  for (const int body : {a, b}) {
    if (!moves(body)) continue;
    const int component = joints_.component_of(body);
    const std::vector<int> connected = component < 0 ? std::vector<int>{body} : joints_.bodies_of(component);
    if (std::find(bodies.begin(), bodies.end(), connected.front()) == bodies.end())
      bodies.insert(bodies.end(), connected.begin(), connected.end());
  }
  return bodies;
}

const std::vector<Vec6>& ImpulseResponses::of(const std::vector<int>& moved, int a, const Vec6& on_a, int b,
                                              const Vec6& on_b) {
  for (const int body : moved) change_[body].setZero();
  if (moves(a)) change_[a] += alone(a, on_a);
  if (moves(b)) change_[b] += alone(b, on_b);
  int last = -1;
  for (const int body : moved) {
    const int component = joints_.component_of(body);
    if (component >= 0 && component != last) joints_.restrict(component, change_), last = component;
  }
  return change_;
}

Vec6 ImpulseResponses::alone(int body, const Vec6& impulse) const {
  if (!moves(body)) return Vec6::Zero();
  const Inertia& inertia = system_.bodies[body];
  const Mat3 R = pose_.rotation(body);
  const Vec3 torque_B = R.transpose() * impulse.tail<3>();
  return joined(inertia.inverse_mass * impulse.head<3>(), R * (inertia.inverse_inertia_B * torque_B));
}

}  // namespace rigor::inline dynamics
