#include "cases/analysis/divergence/ablations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "cases/analysis/divergence/rebased_scene.h"
#include "core/dynamics/collision/narrow_phase.h"
#include "core/scene/contact_laws.h"
#include "core/scene/turn_window.h"

namespace rigor::inline analysis {
namespace {

enum Rank { kFriction, kRestitution, kLimit, kDrive, kContact, kGyroscopic, kForce, kSpring, kJoint, kGravity };

using Change = std::function<void(Scene&)>;

class Ablater {
 public:
  explicit Ablater(const AblatedStep& step) : step_(step), scene_(step.scene) {}

  std::vector<Ablation> all() {
    add_contacts();
    for (std::size_t k = 0; k < scene_.joints.size(); ++k) add_joint(k);
    for (std::size_t c = 0; c < scene_.couplings.size(); ++c) add_coupling(c);
    add_drives();
    for (std::size_t k = 0; k < scene_.springs.size(); ++k) add_spring(k);
    for (std::size_t k = 0; k < scene_.forces.size(); ++k) add_force(k);
    add_gyroscopic();
    if (!scene_.gravity.isZero(0)) add("gravity", "", kGravity, kWorld, kWorld, [](Scene& s) { s.gravity.setZero(); });
    std::stable_sort(found_.begin(), found_.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
    std::vector<Ablation> out;
    for (auto& [distance, ablation] : found_) out.push_back(std::move(ablation));
    return out;
  }

 private:
  // 0 for a part that acts on the body itself.
  int distance_of(int a, int b) const {
    return a == step_.body || b == step_.body || (a == kWorld && b == kWorld) ? 0 : 1;
  }

  void add(const std::string& what, const std::string& detail, Rank rank, int a, int b, const Change& change) {
    Scene changed = scene_;
    change(changed);
    found_.emplace_back(distance_of(a, b), Ablation{what, detail, rank, rank == kJoint, rank >= kJoint,
                                                    std::make_shared<Scene>(std::move(changed))});
  }

  Pose pose(const std::vector<BodyState>& states, int body) const {
    const Body& own = scene_.bodies[static_cast<std::size_t>(body)];
    if (own.fixed) return {own.position, matrix_of(own.orientation)};
    const BodyState& state = states[static_cast<std::size_t>(body)];
    return {state.position, matrix_of(state.orientation)};
  }

  // The nearest point of a pair, its gap and how fast the surfaces slide there.
  struct Touch {
    double gap = 0, slip = 0;  // m, m/s
    double parting = 0;        // m/s: how fast the surfaces come apart
    double reach = 0;          // m: how far they move against each other in a step
  };
  Touch touch_of(const std::vector<BodyState>& states, int a, int b) const {
    Manifold points;
    const Body &first = scene_.bodies[static_cast<std::size_t>(a)],
               &second = scene_.bodies[static_cast<std::size_t>(b)];
    collide(*first.shape, pose(states, a), *second.shape, pose(states, b), points);
    Touch touch{HUGE_VAL, 0, 0, 0};
    for (const ManifoldPoint& point : points) {
      if (point.gap >= touch.gap) continue;
      const auto velocity = [&](int body) -> Vec3 {
        if (scene_.bodies[static_cast<std::size_t>(body)].fixed) return Vec3::Zero();
        const BodyState& own = states[static_cast<std::size_t>(body)];
        return own.velocity + own.angular_velocity.cross(point.point - own.position);
      };
      const Vec3 relative = velocity(a) - velocity(b);
      const double normal = relative.dot(point.normal);
      touch = {point.gap, (relative - normal * point.normal).norm(), normal, relative.norm() * step_.seconds};
    }
    return touch;
  }

  static Change with_law(int a, int b, ContactLaw law) {
    return [=](Scene& s) {
      std::erase_if(s.contact_pairs, [&](const ContactPair& pair) {
        return (pair.a == a && pair.b == b) || (pair.a == b && pair.b == a);
      });
      s.contact_pairs.push_back({a, b, law});
    };
  }

  void add_contacts() {
    const ContactLaws laws(scene_);
    for (int b = 1; b < static_cast<int>(scene_.bodies.size()); ++b) {
      for (int a = 0; a < b; ++a) {
        const Body &first = scene_.bodies[static_cast<std::size_t>(a)],
                   &second = scene_.bodies[static_cast<std::size_t>(b)];
        if (can_meet(first, second) && laws.may_touch(a, b)) add_contact(a, b, laws.of(a, b));
      }
    }
  }

  void add_contact(int a, int b, const ContactLaw& law) {
    const Touch before = touch_of(step_.before, a, b), after = touch_of(step_.after, a, b);
    // Gravity may add to the approach; both engines may look a little ahead.
    const double reach = 2 * (before.reach + scene_.gravity.norm() * step_.seconds * step_.seconds);
    if (std::min(before.gap, after.gap) > reach) return;
    const std::string pair = fmt::format("of '{}' and '{}'", scene_.body_name(a), scene_.body_name(b));
    add("the contact " + pair, contact_detail(before, after), kContact, a, b, with_law(a, b, kApart));
    ContactLaw inelastic = law, smooth = law;
    inelastic.restitution = 0, smooth.friction = smooth.static_friction = 0;
    if (law.restitution > 0)
      add("the restitution " + pair, fmt::format("restitution {:g}", law.restitution), kRestitution, a, b,
          with_law(a, b, inelastic));
    if (law.friction > 0)
      add("the friction " + pair, friction_detail(before, after), kFriction, a, b, with_law(a, b, smooth));
  }

  // A contact rests if its gap and its speed are what gravity makes in some steps. One that approaches faster begins.
  std::string contact_detail(const Touch& before, const Touch& after) const {
    const double speed = 4 * scene_.gravity.norm() * step_.seconds, near = speed * step_.seconds + 1e-9;
    const bool rests = before.gap <= near && std::abs(before.parting) <= speed + 1e-9;
    const char* word = !rests ? "begins" : after.gap > near ? "ends" : "lasts";
    return fmt::format("{}: gap {:.3g} m before, {:.3g} m after", word, unrounded(before.gap), unrounded(after.gap));
  }

  // m: what roundings leave of a closed gap is none.
  static double unrounded(double gap) { return std::abs(gap) < 1e-14 ? 0 : gap; }

  std::string friction_detail(const Touch& before, const Touch& after) const {
    // A contact point that slides a thousandth of what gravity adds in a step stands still.
    const double still = 1e-3 * scene_.gravity.norm() * step_.seconds + 1e-9;
    const char* word = before.slip > still && after.slip <= still   ? "stick begins"
                       : before.slip <= still && after.slip > still ? "slip begins"
                       : after.slip <= still                        ? "sticks"
                                                                    : "slips";
    return fmt::format("{}: {:.3g} m/s before, {:.3g} m/s after", word, before.slip, after.slip);
  }

  void add_joint(std::size_t k) {
    const Joint& joint = scene_.joints[k];
    const std::string name = scene_.joint_name(k);
    const double x = moved(k);
    // Within what the coordinate moves in the step, on either side.
    const double reach = 2 * std::abs(x) + 1e-6;
    if (joint.has_limits() && (joint.lower > -reach || joint.upper < reach)) {
      add("the limit of " + name, fmt::format("from {:.3g} to {:.3g}; it moves by {:.3g}", joint.lower, joint.upper, x),
          kLimit, joint.a, joint.b, [k](Scene& s) {
            s.joints[k].lower = -std::numeric_limits<double>::infinity();
            s.joints[k].upper = std::numeric_limits<double>::infinity();
          });
    }
    if (joint.stiffness > 0 || joint.damping > 0) {
      add("the spring and damper of " + name, "", kSpring, joint.a, joint.b,
          [k](Scene& s) { s.joints[k].stiffness = s.joints[k].quadratic_stiffness = s.joints[k].damping = 0; });
    }
    // An axis of a compound joint locks nothing by itself.
    if (is_axis_of_compound(joint)) return;
    add("the constraint of " + name, "", kJoint, joint.a, joint.b, [k](Scene& s) { remove_joint(s, k); });
  }

  // With what acts on it; of a compound joint with its axes.
  static void remove_joint(Scene& scene, std::size_t first) {
    std::size_t end = first + 1;
    while (end < scene.joints.size() && is_axis_of_compound(scene.joints[end])) ++end;
    const int from = static_cast<int>(first), to = static_cast<int>(end);
    const auto is_gone = [=](int joint) { return from <= joint && joint < to; };
    const auto moved = [=](int joint) { return joint < to ? joint : joint - (to - from); };
    scene.joints.erase(scene.joints.begin() + from, scene.joints.begin() + to);
    const auto has_gone = [&](const JointTerm& term) { return is_gone(term.joint); };
    std::erase_if(scene.motors, [&](const Motor& motor) {
      return is_gone(motor.joint) || std::any_of(motor.plus.begin(), motor.plus.end(), has_gone);
    });
    std::erase_if(scene.couplings, [&](const Coupling& row) {
      return is_gone(row.joint) || std::any_of(row.to.begin(), row.to.end(), has_gone);
    });
    renumber_joints(scene, moved);
  }

  // It passes on differences as the constraint of a joint does.
  void add_coupling(std::size_t c) {
    const Joint& joint = scene_.joints[static_cast<std::size_t>(scene_.couplings[c].joint)];
    add(scene_.coupling_name(c), "", kJoint, joint.a, joint.b,
        [c](Scene& s) { s.couplings.erase(s.couplings.begin() + static_cast<long>(c)); });
  }

  // The change of a joint's coordinate in the step.
  double moved(std::size_t k) const {
    JointCoordinates coordinates(scene_);
    coordinates.follow(step_.after);
    return coordinates.values()[k];
  }

  void add_drives() {
    for (std::size_t m = 0; m < scene_.motors.size(); ++m) {
      const Motor& motor = scene_.motors[m];
      if (motor.from >= step_.seconds) continue;
      const auto k = static_cast<std::size_t>(motor.joint);
      const Joint& joint = scene_.joints[k];
      const char* kind = motor.is_friction ? "the dry friction" : "the drive";
      add(fmt::format("{} of {}", kind, scene_.joint_name(k)), drive_detail(motor, k), kDrive, joint.a, joint.b,
          [m](Scene& s) { s.motors.erase(s.motors.begin() + static_cast<long>(m)); });
    }
  }

  std::string drive_detail(const Motor& motor, std::size_t k) const {
    if (!motor.servo || !std::isfinite(motor.servo->most)) return "";
    const double rate = moved(k) / step_.seconds;
    const double effort = motor.servo->unbounded(0, rate, 0, takes_the_shorter_way(scene_.joints[k]));
    const bool is_saturated = std::abs(effort) >= motor.servo->most;
    return fmt::format("{}: it asks for {:.3g}, and may give {:.3g}", is_saturated ? "saturated" : "not saturated",
                       effort, motor.servo->most);
  }

  void add_spring(std::size_t k) {
    const Spring& spring = scene_.springs[k];
    add(fmt::format("the spring of '{}' and '{}'", scene_.body_name(spring.a), scene_.body_name(spring.b)), "", kSpring,
        spring.a, spring.b, [k](Scene& s) { s.springs.erase(s.springs.begin() + static_cast<long>(k)); });
  }

  void add_force(std::size_t k) {
    const TimedForce& force = scene_.forces[k];
    if (force.from >= step_.seconds) return;
    add(fmt::format("the timed force on '{}'", scene_.body_name(force.body)), "", kForce, force.body, force.body,
        [k](Scene& s) { s.forces.erase(s.forces.begin() + static_cast<long>(k)); });
  }

  // The body whose difference is explained, with equal moments: w x I w is then 0.
  void add_gyroscopic() {
    const auto i = static_cast<std::size_t>(step_.body);
    const Mat3 R = matrix_of(step_.before[i].orientation);
    const Vec3 w = step_.before[i].angular_velocity;
    const Mat3 inertia = R * scene_.bodies[i].inertia * R.transpose();
    const Vec3 torque = w.cross(inertia * w);
    // Rounding leaves this much of the torque of a ball.
    if (torque.norm() <= 1e-12 * inertia.norm() * w.squaredNorm()) return;
    const double change = (inertia.inverse() * torque).norm() * step_.seconds;
    add(fmt::format("the gyroscopic term of '{}'", scene_.body_name(step_.body)),
        fmt::format("it changes {:.3g} rad/s by {:.3g} rad/s in the step", w.norm(), change), kGyroscopic, step_.body,
        step_.body, [i](Scene& s) { s.bodies[i].inertia = s.bodies[i].inertia.trace() / 3 * Mat3::Identity(); });
  }

  const AblatedStep& step_;
  const Scene& scene_;
  std::vector<std::pair<int, Ablation>> found_;
};

}  // namespace

std::vector<Ablation> ablations_of(const AblatedStep& step, std::size_t most) {
  std::vector<Ablation> all = Ablater(step).all();
  if (all.size() > most) all.resize(most);
  return all;
}

}  // namespace rigor::inline analysis
