// Bodies on one line in empty space that collide centre to centre. Each impact conserves the momentum of the two and
// leaves e times their approach speed. The normal impulse is (1 + e) v m1 m2/(m1 + m2) (Newton's law of restitution;
// Goldsmith, Impact, 1960, chapter 2). A fixed body has infinite mass. Simultaneous impacts, as in Newton's cradle, are
// solved as the limit of vanishing gaps: one after another from the arriving body. If one end of a row of equal bodies
// is struck, the last body leaves with the speed of the first.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "cases/truth/closed_form/contact/plane_contact.h"
#include "cases/truth/closed_form/phased_motion.h"
#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

constexpr const char* kLineImpacts = "line-impacts";
constexpr const char* kLineImpactsIsFor =
    "bodies without gravity whose centres move along the one line that they all lie on";

[[noreturn]] void refuse_line(const std::string& why) {
  throw InputError(fmt::format("the truth '{}' is for {}: {}", kLineImpacts, kLineImpactsIsFor, why));
}

// A body as the line sees it.
struct Bead {
  int body;
  Extended at, speed, half, inverse_mass;  // m, m/s, m along the line, 1/kg
};

class Line {
 public:
  explicit Line(const Scene& scene) : scene_(scene) {
    if (!scene.gravity.isZero(0)) refuse_line("there is gravity");
    direction_ = find_direction();
    for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
      if (scene.bodies[i].collides || !scene.bodies[i].fixed) beads_.push_back(bead_of(i));
      phases_.emplace_back();
    }
    std::sort(beads_.begin(), beads_.end(), [](const Bead& a, const Bead& b) { return a.at < b.at; });
    for (std::size_t i = 1; i < beads_.size(); ++i) {
      if (gap(i) < -kTouching)
        refuse_line(fmt::format("bodies '{}' and '{}' overlap", name(beads_[i - 1]), name(beads_[i])));
      widest_touch_ = std::max(widest_touch_, std::abs(gap(i)) < kTouching ? std::abs(gap(i)) : 0);
    }
    for (const Bead& bead : beads_) note(bead);
  }

  void run(double duration) {
    constexpr int kMost = 100000;  // impacts: far beyond any case, and done in a moment
    for (int n = 0; n < kMost; ++n) {
      std::size_t next = 0;
      Extended least = std::numeric_limits<Extended>::infinity();
      for (std::size_t i = 1; i < beads_.size(); ++i) {
        const Extended time = time_to_impact(i);
        if (time < least) least = time, next = i;
      }
      if (time_ + least > duration) return;
      time_ += least;
      for (Bead& bead : beads_) bead.at += least * bead.speed;
      collide(beads_[next - 1], beads_[next]);
    }
    refuse_line(fmt::format("there are more than {} impacts", kMost));
  }

  std::unique_ptr<BodyMotion> motion_of(const Body& body) const {
    return std::make_unique<PhasedMotion>(phases_[&body - scene_.bodies.data()], static_cast<double>(widest_touch_));
  }

 private:
  const std::string& name(const Bead& bead) const { return scene_.bodies[bead.body].name; }
  ExtendedVec3 origin() const { return extended(scene_.bodies.front().position); }

  ExtendedVec3 find_direction() const {
    for (const Body& body : scene_.bodies) {
      if (body.shape && std::holds_alternative<Plane>(*body.shape))
        refuse_line(fmt::format("body '{}' is a plane", body.name));
      const ExtendedVec3 way = extended(body.position) - origin();
      if (way.norm() > 0) return way.normalized();
    }
    refuse_line("there is but one body");
  }

  Bead bead_of(int index) const {
    const Body& body = scene_.bodies[index];
    if (!body.collides) refuse_line(fmt::format("body '{}' does not collide", body.name));
    const ExtendedVec3 from = extended(body.position) - origin(), v = extended(body.velocity);
    if (!are_along(from, direction_) || !are_along(v, direction_))
      refuse_line(fmt::format("body '{}' is, or moves, beside the line", body.name));
    if (!body.angular_velocity.isZero(0)) refuse_line(fmt::format("body '{}' turns", body.name));
    return {index, from.dot(direction_), v.dot(direction_), half_length(body),
            body.fixed ? 0 : 1 / Extended(body.mass)};
  }

  // m, from the centre to the surface along the line, which must meet that surface at right angles.
  Extended half_length(const Body& body) const {
    if (const auto* sphere = std::get_if<Sphere>(&*body.shape)) return sphere->radius;
    const ExtendedVec3 along = extended(body.orientation).conjugate() * direction_;
    int axis = 0;
    const bool is_axis = std::abs(along.cwiseAbs().maxCoeff(&axis) - 1) < 1e-12L;
    if (const auto* box = std::get_if<Box>(&*body.shape); box && is_axis) return Extended(box->size[axis]) / 2;
    const auto* capsule = std::get_if<Capsule>(&*body.shape);
    if (capsule && is_axis) return capsule->radius + (axis == 2 ? Extended(capsule->length) / 2 : 0);
    refuse_line(fmt::format("the line does not meet the {} '{}' at right angles", shape_name(*body.shape), body.name));
  }

  Extended gap(std::size_t i) const { return beads_[i].at - beads_[i].half - (beads_[i - 1].at + beads_[i - 1].half); }

  // s; infinite for two that do not approach each other beyond rounding.
  Extended time_to_impact(std::size_t i) const {
    const Extended approach = beads_[i - 1].speed - beads_[i].speed;
    const Extended rounding = 64 * std::numeric_limits<Extended>::epsilon();
    if (approach <= rounding * (std::abs(beads_[i - 1].speed) + std::abs(beads_[i].speed)))
      return std::numeric_limits<Extended>::infinity();
    return std::max<Extended>(0, std::abs(gap(i)) < kTouching && time_ == 0 ? 0 : gap(i)) / approach;
  }

  void collide(Bead& a, Bead& b) {
    const Extended restitution = scene_.contact_law(a.body, b.body).restitution;
    const Extended both = a.inverse_mass + b.inverse_mass, impulse = (1 + restitution) * (a.speed - b.speed) / both;
    const Extended common = (a.speed * b.inverse_mass + b.speed * a.inverse_mass) / both;  // of the centre of mass
    a.speed -= impulse * a.inverse_mass;
    b.speed += impulse * b.inverse_mass;
    if (restitution == 0) a.speed = b.speed = common;  // to the last digit, so that they do not meet again
    note(a), note(b);
  }

  void note(const Bead& bead) {
    const Body& body = scene_.bodies[bead.body];
    phases_[bead.body].push_back(
        {time_,
         {origin() + bead.at * direction_, extended(body.orientation), bead.speed * direction_, ExtendedVec3::Zero()}});
  }

  const Scene& scene_;
  ExtendedVec3 direction_;
  std::vector<Bead> beads_;  // in their order on the line
  std::vector<std::vector<Phase>> phases_;
  Extended time_ = 0, widest_touch_ = 0;
};

std::unique_ptr<Truth> make_line_impacts(const Scene& scene, double duration) {
  if (!scene.springs.empty() || !scene.joints.empty() || !scene.forces.empty())
    refuse_line("this scene has springs, joints or forces");
  Line line(scene);
  line.run(duration);
  return closed_form(scene, [&](const Body& body) { return line.motion_of(body); });
}

}  // namespace

TruthRow line_impacts_truth() {
  return {kLineImpacts, "bodies that run into each other along one line, impact by impact, in closed form",
          make_line_impacts};
}

}  // namespace rigor::inline truth
