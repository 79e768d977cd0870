// Bodies on hinges, sliders and screws to what stands still, with gears between them, under constant loads. All move
// with one coordinate q: of joint j the coordinate is r_j q, with r = 1 for the first. Then q'' = Q/M is constant:
//   M = sum r_j² (m_j + armature_j)                    m_j: the mass on a slider, n . I n on a hinge,
//   Q = sum r_j (m_j g . n_j, or of a hinge 0, + E_j)  E_j: constant efforts of motors
// A screw's coordinate is its angle, with n . I n + m k², k = pitch / 2 pi, and the load m k g . n. Bodies have their
// centres of mass on the axes of hinges and screws (Goldstein, Classical Mechanics, 3rd ed., section 1.4).
#include <fmt/format.h>

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <vector>

#include "cases/truth/closed_form/joint/swinging_body.h"
#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

[[noreturn]] void refuse_transmission(const std::string& why) {
  throw InputError("the truth 'transmission' is for bodies on hinges, sliders and screws that move together: " + why);
}

constexpr double kTransmissionRoundings = 64 * kEpsilon;  // of the scene's numbers

// A body on a joint whose coordinate is 1.
struct Driven {
  int body = kWorld;
  ExtendedVec3 axis = ExtendedVec3::Zero();  // unit, in W; the way it takes as the coordinate grows
  Extended way = 0, angle = 0;               // m, rad for each unit of the coordinate
  Extended inertia = 0, load = 0;            // kg or kg m²; N or N m
  Extended rate = 0;                         // of the coordinate at t = 0
  Extended ratio = 0;                        // of the coordinate to q; 0 until it is known
};

class Together final : public BodyMotion {
 public:
  Together(const Body& body, const Driven& driven, Extended rate, Extended acceleration)
      : start_(extended(body.position)),
        orientation_(extended(body.orientation)),
        driven_(driven),
        rate_(driven.ratio * rate),
        acceleration_(driven.ratio * acceleration) {}

  ExtendedState at(Extended t) const override {
    const Extended x = rate_ * t + acceleration_ * t * t / 2, speed = rate_ + acceleration_ * t;
    return {start_ + driven_.way * x * driven_.axis, turn(driven_.angle * x * driven_.axis) * orientation_,
            driven_.way * speed * driven_.axis, driven_.angle * speed * driven_.axis};
  }

  double error(double t) const override {
    const Extended x = std::abs(rate_) * t + std::abs(acceleration_) * t * t / 2;
    return kEpsilon * static_cast<double>(start_.norm() + std::abs(driven_.way) * x) +
           8 * kExtendedEpsilon * static_cast<double>(std::abs(driven_.angle) * x);
  }

 private:
  ExtendedVec3 start_;
  ExtendedQuat orientation_;
  Driven driven_;
  Extended rate_, acceleration_;  // of the body's coordinate
};

class TransmissionScene {
 public:
  explicit TransmissionScene(const Scene& scene) : scene_(scene) {
    for (std::size_t k = 0; k < scene.joints.size(); ++k) all_.push_back(driven_by(k));
    for (const Motor& motor : scene.motors) {
      const bool is_constant = motor.gives_effort() && !motor.efforts && motor.from == 0 && !std::isfinite(motor.until);
      if (!is_constant) refuse_transmission("a motor gives no constant effort");
      all_[static_cast<std::size_t>(motor.joint)].load += motor.effort;
    }
    find_ratios();
    for (const Body& body : scene.bodies) {
      if (!body.fixed && on(body) == all_.end())
        refuse_transmission(fmt::format("body '{}' hangs on no joint", body.name));
    }
  }

  std::unique_ptr<Truth> truth() const {
    Extended inertia = 0, load = 0;
    for (const Driven& driven : all_)
      inertia += driven.ratio * driven.ratio * driven.inertia, load += driven.ratio * driven.load;
    const Extended rate = all_.front().rate;
    for (const Driven& driven : all_) {
      if (std::abs(driven.rate - driven.ratio * rate) > kTransmissionRoundings * (1 + std::abs(driven.rate)))
        refuse_transmission("the initial velocities do not fit together");
    }
    return closed_form(
        scene_, [&](const Body& body) { return std::make_unique<Together>(body, *on(body), rate, load / inertia); });
  }

 private:
  std::vector<Driven>::const_iterator on(const Body& body) const {
    const int index = static_cast<int>(&body - scene_.bodies.data());
    return std::find_if(all_.begin(), all_.end(), [&](const Driven& driven) { return driven.body == index; });
  }

  Driven driven_by(std::size_t k) const {
    const Joint& joint = scene_.joints[k];
    if (stands(scene_, joint.a) == stands(scene_, joint.b))
      refuse_transmission("a joint is not between a body and what stands still");
    const bool is_b = stands(scene_, joint.a);
    const Body& body = scene_.bodies[static_cast<std::size_t>(is_b ? joint.b : joint.a)];
    Driven driven;
    driven.body = is_b ? joint.b : joint.a;
    if (on(body) != all_.end()) refuse_transmission("a body hangs on two joints");
    if (joint.stiffness != 0 || joint.damping != 0) refuse_transmission("a joint has a spring or a damper");
    const Vec3* axis = axis_of(joint);
    if (!axis) refuse_transmission("a joint has no axis");
    driven.axis = (is_b ? 1 : -1) * extended(*axis).normalized();
    const ExtendedMat3 R = extended(body.orientation).toRotationMatrix();
    const ExtendedVec3 momentum = R * extended(body.inertia) * R.transpose() * driven.axis;
    const Extended mass = body.mass, moment = driven.axis.dot(momentum),
                   weight = mass * driven.axis.dot(extended(scene_.gravity));
    if (std::holds_alternative<SliderJoint>(joint.type)) {
      driven.way = 1, driven.inertia = mass, driven.load = weight;
      driven.rate = driven.axis.dot(extended(body.velocity));
    } else {
      check_centre(joint, body, driven.axis);
      driven.angle = 1, driven.inertia = moment;
      driven.rate = driven.axis.dot(extended(body.angular_velocity));
      if (const auto* screw = std::get_if<ScrewJoint>(&joint.type)) {
        driven.way = Extended(screw->pitch) / boost::math::constants::two_pi<Extended>();
        driven.inertia += mass * driven.way * driven.way, driven.load = driven.way * weight;
      }
    }
    driven.inertia += joint.armature;
    return driven;
  }

  static void check_centre(const Joint& joint, const Body& body, const ExtendedVec3& axis) {
    const ExtendedVec3 arm = extended(body.position) - extended(*anchor_of(joint));
    if (axis.cross(arm).norm() > kTransmissionRoundings * (1 + arm.norm()))
      refuse_transmission("a centre of mass is off its axis");
  }

  // Along the couplings from the first joint.
  void find_ratios() {
    if (all_.empty()) refuse_transmission("there is no joint");
    all_.front().ratio = 1;
    for (std::size_t pass = 0; pass < all_.size(); ++pass) {
      for (const Coupling& coupling : scene_.couplings) {
        const JointTerm& term = coupling.to.front();  // the only one
        Driven &one = all_[static_cast<std::size_t>(coupling.joint)], &to = all_[static_cast<std::size_t>(term.joint)];
        if (to.ratio != 0 && one.ratio == 0) one.ratio = Extended(term.ratio) * to.ratio;
        if (one.ratio != 0 && to.ratio == 0) to.ratio = one.ratio / Extended(term.ratio);
      }
    }
    if (std::any_of(all_.begin(), all_.end(), [](const Driven& driven) { return driven.ratio == 0; }))
      refuse_transmission("some joints are not coupled to the first");
  }

  const Scene& scene_;
  std::vector<Driven> all_;  // by joint
};

}  // namespace

TruthRow transmission_truth() {
  return {"transmission", "bodies on hinges, sliders and screws that move together at a constant acceleration",
          [](const Scene& scene, double) {
            check_needs(scene, "transmission", "bodies on hinges, sliders and screws that move together",
                        {joint_feature<HingeJoint>(), joint_feature<SliderJoint>(), joint_feature<ScrewJoint>(),
                         Feature::armature, Feature::coupling, Feature::motor_effort});
            return TransmissionScene(scene).truth();
          }};
}

}  // namespace rigor::inline truth
