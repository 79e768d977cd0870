// Plane linkages of one angle whose inertia does not change as they turn (swinging_body.h):
//   parallel cranks   bodies on hinges to what stands still, all turning alike, and bodies that they carry without
//                     turning them (IFToMM benchmark A02: N windows; x'' = lambda sin x from the upright)
//   a trammel         a body hinged to two sliders that run at right angles
// If all cranks and couplers lie in one line, a linkage could fold. This truth then continues as parallel cranks do.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "cases/truth/closed_form/joint/plane_freedoms.h"
#include "cases/truth/closed_form/joint/swinging_body.h"
#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

[[noreturn]] void refuse_linkage(const std::string& why) {
  throw InputError("the truth 'linkage' is for parallel cranks with what they carry, and for trammels: " + why);
}

constexpr Extended kLinkageRoundings = 64 * static_cast<Extended>(kEpsilon);  // of the scene's numbers, relative

class Linkage {
 public:
  explicit Linkage(const Scene& scene) : scene_(scene), swings_(scene.bodies.size()) {
    find_axis();
    if (!place_cranks()) place_trammel();
    for (const Joint& joint : scene.joints) check(joint);
    check_freedom();
  }

  const ExtendedVec3& axis() const { return axis_; }
  std::vector<Swing> swings() const {
    std::vector<Swing> all;
    for (std::size_t i = 0; i < swings_.size(); ++i) {
      if (scene_.bodies[i].fixed) continue;
      if (!swings_[i]) refuse_linkage(fmt::format("nothing says how body '{}' moves", scene_.bodies[i].name));
      all.push_back(*swings_[i]);
    }
    return all;
  }

 private:
  static const HingeJoint* hinge_of(const Joint& joint) { return std::get_if<HingeJoint>(&joint.type); }
  static const SliderJoint* slider_of(const Joint& joint) { return std::get_if<SliderJoint>(&joint.type); }
  bool is_still(int body) const { return stands(scene_, body); }
  ExtendedVec3 centre(int body) const { return extended(scene_.bodies[body].position); }

  void find_axis() {
    for (const Joint& joint : scene_.joints) {
      if (const auto* hinge = hinge_of(joint)) {
        const ExtendedVec3 axis = extended(hinge->axis).normalized();
        if (axis_.isZero(0)) axis_ = axis;
        if (axis.cross(axis_).norm() > kLinkageRoundings) refuse_linkage("its hinges are not parallel");
      } else if (!slider_of(joint)) {
        refuse_linkage("it has joints other than hinges and sliders");
      }
    }
    if (axis_.isZero(0)) refuse_linkage("it has no hinge");
  }

  // Cranks hinged to a fixed body rotate. Bodies that hang on one of them move as its tip does.
  bool place_cranks() {
    bool found = false;
    for (const Joint& joint : scene_.joints) {
      const auto* hinge = hinge_of(joint);
      if (!hinge || is_still(joint.a) == is_still(joint.b)) continue;
      const int body = is_still(joint.a) ? joint.b : joint.a;
      swings_[body] = round_axis(body, axis_, centre(body) - extended(hinge->anchor), true);
      found = true;
    }
    for (const Joint& joint : scene_.joints) {
      const auto* hinge = hinge_of(joint);
      if (!hinge || is_still(joint.a) || is_still(joint.b)) continue;
      for (const auto& [crank, carried] : {std::pair{joint.a, joint.b}, {joint.b, joint.a}}) {
        if (!swings_[crank] || !swings_[crank]->turns || swings_[carried]) continue;
        Swing tip = of_point(crank, extended(hinge->anchor));
        tip.body = carried, tip.turns = false;
        swings_[carried] = tip;
      }
    }
    return found;
  }

  // A rod between two runners: with e from one of its ends to the other, each runner is e's part along its rail.
  void place_trammel() {
    std::vector<std::pair<int, ExtendedVec3>> runners;
    for (const Joint& joint : scene_.joints) {
      if (!slider_of(joint)) continue;
      if (is_still(joint.a) == is_still(joint.b))
        refuse_linkage("a slider is not between a runner and what stands still");
      runners.emplace_back(is_still(joint.a) ? joint.b : joint.a, extended(slider_of(joint)->axis).normalized());
    }
    if (runners.size() != 2) refuse_linkage(fmt::format("there are no cranks, and {} runners", runners.size()));
    const auto& [first, rail] = runners[0];
    const auto& [second, other_rail] = runners[1];
    if (std::abs(rail.dot(other_rail)) > kLinkageRoundings) refuse_linkage("the rails are not at right angles");
    const int rod = rod_between(first, second);
    const ExtendedVec3 e = pin(rod, first) - pin(rod, second), turned = axis_.cross(e);
    swings_[first] = {first, rail.dot(e) * rail, rail.dot(turned) * rail, false};
    swings_[second] = {second, -other_rail.dot(e) * other_rail, -other_rail.dot(turned) * other_rail, false};
    const Swing arm = round_axis(rod, axis_, centre(rod) - pin(rod, first), true);
    swings_[rod] = {rod, swings_[first]->along + arm.along, swings_[first]->across + arm.across, true};
  }

  int rod_between(int first, int second) const {
    for (int rod = 0; rod < static_cast<int>(scene_.bodies.size()); ++rod) {
      if (hinge_between(rod, first) && hinge_between(rod, second)) return rod;
    }
    refuse_linkage("no body is hinged to both runners");
  }
  const HingeJoint* hinge_between(int one, int other) const {
    for (const Joint& joint : scene_.joints) {
      if ((joint.a == one && joint.b == other) || (joint.a == other && joint.b == one)) return hinge_of(joint);
    }
    return nullptr;
  }
  ExtendedVec3 pin(int rod, int runner) const { return extended(hinge_between(rod, runner)->anchor); }

  // The motion of a point of a body; zero for a fixed body.
  Swing of_point(int body, const ExtendedVec3& point) const {
    if (is_still(body)) return {};
    Swing swing = swings_[body].value_or(Swing{});
    if (!swing.turns) return swing;
    const Swing arm = round_axis(body, axis_, point - centre(body), true);
    swing.along += arm.along, swing.across += arm.across;
    return swing;
  }

  // Checks that a joint holds for any angle.
  void check(const Joint& joint) const {
    const auto* slider = slider_of(joint);
    const ExtendedVec3 point = slider ? ExtendedVec3::Zero() : extended(hinge_of(joint)->anchor);
    const Swing a = of_point(joint.a, point), b = of_point(joint.b, point);
    ExtendedVec3 along = b.along - a.along, across = b.across - a.across;
    if (slider) {
      if (a.turns || b.turns) refuse_linkage("a runner turns");
      const ExtendedVec3 rail = extended(slider->axis).normalized();
      along -= rail.dot(along) * rail, across -= rail.dot(across) * rail;
    }
    const Extended size = 1 + a.along.norm() + b.along.norm();
    if (along.norm() + across.norm() > kLinkageRoundings * size)
      refuse_linkage(fmt::format("the joint of '{}' and '{}' would part as it turns", scene_.body_name(joint.a),
                                 scene_.body_name(joint.b)));
  }

  // Checks that the angle is the only freedom. Links in one line are an exception, but two poses are never both such.
  void check_freedom() const {
    constexpr Extended kAway = 0.7L;  // rad
    const int least = std::min(freedoms_at(0), freedoms_at(kAway));
    if (least != 1) refuse_linkage(fmt::format("it has {} freedoms, not one", least));
  }
  int freedoms_at(Extended angle) const {
    std::vector<PlanePose> poses(scene_.bodies.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Swing swing = swings_[i].value_or(Swing{});
      const int body = static_cast<int>(i);
      poses[i] = {centre(body) + (std::cos(angle) - 1) * swing.along + std::sin(angle) * swing.across,
                  swing.turns ? angle : 0};
    }
    return plane_freedoms(scene_, axis_, poses);
  }

  const Scene& scene_;
  ExtendedVec3 axis_ = ExtendedVec3::Zero();
  std::vector<std::optional<Swing>> swings_;  // of each body
};

std::unique_ptr<Truth> make_linkage(const Scene& scene, double) {
  check_needs(scene, "linkage", "hinges and sliders in a plane",
              {joint_feature<HingeJoint>(), joint_feature<SliderJoint>()});
  const Linkage linkage(scene);
  return swinging(scene, linkage.axis(), linkage.swings(), false, refuse_linkage);
}

}  // namespace

TruthRow linkage_truth() {
  return {"linkage", "parallel cranks with what they carry, and trammels, in elliptic functions", make_linkage};
}

}  // namespace rigor::inline truth
