#include "cases/truth/closed_form/contact/plane_contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

struct Segment {
  ExtendedVec3 from, to;
};

Extended to_segment(const ExtendedVec3& point, const Segment& s) {
  const ExtendedVec3 way = s.to - s.from;
  const Extended square = way.squaredNorm();
  const Extended share = square > 0 ? std::clamp<Extended>((point - s.from).dot(way) / square, 0, 1) : 0;
  return (point - s.from - share * way).norm();
}

bool cross(const Segment& a, const Segment& b, const ExtendedVec3& normal) {
  const auto side = [&](const Segment& s, const ExtendedVec3& p) {
    return normal.dot((s.to - s.from).cross(p - s.from));
  };
  return side(a, b.from) * side(a, b.to) < 0 && side(b, a.from) * side(b, a.to) < 0;
}

// The distance between two segments in a plane: zero where they cross, else that of an end to the other.
Extended between(const Segment& a, const Segment& b, const ExtendedVec3& normal) {
  if (cross(a, b, normal)) return 0;
  return std::min({to_segment(a.from, b), to_segment(a.to, b), to_segment(b.from, a), to_segment(b.to, a)});
}

Extended between(const SweptDisk& a, const SweptDisk& b, const ExtendedVec3& normal) {
  const auto flat = [&](const ExtendedVec3& p) { return ExtendedVec3(p - normal.dot(p) * normal); };
  Extended least = std::numeric_limits<Extended>::infinity();
  for (std::size_t i = 1; i < a.way.size(); ++i) {
    for (std::size_t j = 1; j < b.way.size(); ++j) {
      const Segment one{flat(a.way[i - 1]), flat(a.way[i])}, other{flat(b.way[j - 1]), flat(b.way[j])};
      least = std::min(least, between(one, other, normal));
    }
  }
  return least;
}

}  // namespace

Ground::Ground(const Scene& scene, const std::string& truth, const std::string& is_for)
    : truth_(truth), is_for_(is_for) {
  const auto refuse_scene = [&](const std::string& why) {
    throw InputError(fmt::format("the truth '{}' is for {}: {}", truth_, is_for_, why));
  };
  if (!scene.springs.empty()) refuse_scene("this scene has springs");
  if (!scene.joints.empty()) refuse_scene("this scene has joints");
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const Body& body = scene.bodies[i];
    if (!body.fixed || !body.collides) continue;
    if (!std::holds_alternative<Plane>(*body.shape))
      refuse_scene(fmt::format("body '{}' is a fixed {}", body.name, shape_name(*body.shape)));
    if (body_ != kWorld) refuse_scene(fmt::format("'{}' is a second plane", body.name));
    body_ = i;
  }
  if (body_ == kWorld) refuse_scene("there is no plane that collides");
  const Plane& plane = std::get<Plane>(*scene.bodies[body_].shape);
  normal_ = extended(plane.normal).normalized(), offset_ = plane.offset;
  pressing_ = -normal_.dot(extended(scene.gravity));
  along_ = part_along(extended(scene.gravity));
  if (along_.norm() <= 8 * static_cast<Extended>(kEpsilon) * pressing_) along_.setZero();  // roundings of the normal
  if (!(pressing_ > 0)) refuse_scene(fmt::format("gravity does not press bodies on '{}'", scene.bodies[body_].name));
}

double Ground::gap_under(const Body& body) const {
  const Extended centre = normal_.dot(extended(body.position)) - offset_;
  if (const auto* sphere = std::get_if<Sphere>(&*body.shape)) return static_cast<double>(centre - sphere->radius);
  const ExtendedVec3 normal_B = extended(body.orientation).conjugate() * normal_;
  if (const auto* cylinder = std::get_if<Cylinder>(&*body.shape)) {
    const Extended across = std::hypot(normal_B.x(), normal_B.y());
    return static_cast<double>(centre - cylinder->radius * across -
                               static_cast<Extended>(cylinder->length) / 2 * std::abs(normal_B.z()));
  }
  const auto* box = std::get_if<Box>(&*body.shape);
  if (!box) refuse(body, fmt::format("is a {}", shape_name(*body.shape)));
  return static_cast<double>(centre - normal_B.cwiseAbs().dot(extended(box->size)) / 2);
}

void Ground::refuse(const Body& body, const std::string& why) const {
  throw InputError(fmt::format("the truth '{}' is for {}; body '{}' {}", truth_, is_for_, body.name, why));
}

bool are_along(const ExtendedVec3& a, const ExtendedVec3& b) {
  constexpr Extended kDigits = 1e-12L;  // rad
  return a.cross(b).norm() <= kDigits * a.norm() * b.norm();
}

void check_apart(const std::vector<SweptDisk>& sweeps, const Ground& ground) {
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (between(sweeps[i], sweeps[j], ground.normal()) > sweeps[i].radius + sweeps[j].radius) continue;
      ground.refuse(*sweeps[j].body, fmt::format("could touch '{}' on its way", sweeps[i].body->name));
    }
  }
}

}  // namespace rigor::inline truth
