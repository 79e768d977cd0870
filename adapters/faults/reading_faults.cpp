// Wrong reports of a correct state.
#include "adapters/faults/changes.h"
#include "adapters/faults/faults.h"

namespace rigor::inline adapters {
namespace {

using namespace faulty;

BodyState in_single(const BodyState& s) {
  const Quat& q = s.orientation;
  return {single(s.position), Quat(single(q.w()), single(q.x()), single(q.y()), single(q.z())), single(s.velocity),
          single(s.angular_velocity)};
}

void reversed_order(MutableBodyColumns bodies, const Scene&) {
  for (std::size_t i = 0, j = bodies.size() - 1; i < j; ++i, --j) {
    const BodyState one = BodyColumns(bodies).body(i), other = BodyColumns(bodies).body(j);
    bodies.set_body(i, other), bodies.set_body(j, one);
  }
}

template <typename F>
Fault reading_by(const std::string& pattern, double amount, F change) {
  return by_amount(pattern, amount,
                   [=](double by) { return on_reading("", [=](BodyState& state) { change(state, by); }); });
}

}  // namespace

std::vector<Fault> reading_faults() {
  Fault wrong_order{"bodies read back in the wrong order"}, late{"state read before the step"};
  wrong_order.read = reversed_order, late.reads_late = true;
  return {
      on_reading("quaternion order swapped on reading",
                 [](BodyState& s) { s.orientation = w_taken_last(s.orientation); }),
      on_reading("conjugate rotation on reading", [](BodyState& s) { s.orientation = s.orientation.conjugate(); }),
      on_reading("angular velocity read in the body frame",
                 [](BodyState& s) { s.angular_velocity = s.orientation.conjugate() * s.angular_velocity; }),
      on_reading("angular velocity reversed on reading", [](BodyState& s) { s.angular_velocity *= -1; }),
      reading_by("velocity off by {} % on reading", 1,
                 [](BodyState& s, double percent) { s.velocity *= 1 + percent / 100; }),
      reading_by("quaternion too long by {} %", 0.01,
                 [](BodyState& s, double percent) { s.orientation.coeffs() *= 1 + percent / 100; }),
      reading_by("position of a point {} mm beside the centre", 1,
                 [](BodyState& s, double mm) { s.position += s.orientation * Vec3(0, 0, 1e-3 * mm); }),
      reading_by("bodies {} mm beside their joints on reading", 1,
                 [](BodyState& s, double mm) { s.position.z() += 1e-3 * mm; }),
      on_reading("single precision on reading", [](BodyState& s) { s = in_single(s); }),
      on_reading("left-handed axes on reading", [](BodyState& s) { s.position.x() *= -1; }),
      wrong_order,
      late,
  };
}

}  // namespace rigor::inline adapters
