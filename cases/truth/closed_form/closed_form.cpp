#include "cases/truth/closed_form/closed_form.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/scene/features/features.h"

namespace rigor::inline truth {
namespace {

class ClosedForm final : public Truth {
 public:
  ClosedForm(const Scene& scene, const std::function<std::unique_ptr<BodyMotion>(const Body&)>& motion_of) {
    for (const Body& body : scene.bodies) {
      standing_.push_back({body.position, body.orientation, Vec3::Zero(), Vec3::Zero()});
      motions_.push_back(body.fixed ? nullptr : motion_of(body));
    }
  }

  void at(double t, MutableBodyColumns out) const override {
    for (std::size_t i = 0; i < motions_.size(); ++i) {
      if (!motions_[i]) {
        out.set_body(i, standing_[i]);
        continue;
      }
      const ExtendedState now = motions_[i]->at(t);
      out.set_body(i, {now.position.cast<double>(), now.orientation.cast<double>(), now.velocity.cast<double>(),
                       now.angular_velocity.cast<double>()});
    }
  }

  // Rounding the four numbers of a quaternion by half an ulp each turns it by less than two.
  double error(double t) const override {
    double largest = 0;
    for (std::size_t i = 0; i < motions_.size(); ++i) {
      if (motions_[i]) largest = std::max(largest, motions_[i]->error(t));
    }
    return largest + 2 * kEpsilon;
  }

 private:
  std::vector<BodyState> standing_;                   // of each body at t = 0
  std::vector<std::unique_ptr<BodyMotion>> motions_;  // null for a fixed body
};

}  // namespace

ExtendedQuat turn(const ExtendedVec3& angle) {
  const Extended theta = angle.norm();
  if (theta == 0) return ExtendedQuat::Identity();
  const ExtendedVec3 u = angle * (std::sin(theta / 2) / theta);
  return {std::cos(theta / 2), u.x(), u.y(), u.z()};
}

std::unique_ptr<Truth> closed_form(const Scene& scene,
                                   const std::function<std::unique_ptr<BodyMotion>(const Body&)>& motion_of) {
  return std::make_unique<ClosedForm>(scene, motion_of);
}

void check_needs(const Scene& scene, const std::string& truth, const std::string& is_for, const Features& allowed) {
  for (const Need& need : needs_of(scene)) {
    if (need.feature == Feature::fixed_body || allowed.contains(need.feature)) continue;
    throw InputError(fmt::format("the truth '{}' is for {}; this scene has {}: {}", truth, is_for,
                                 word_of(need.feature), need.because));
  }
}

}  // namespace rigor::inline truth
