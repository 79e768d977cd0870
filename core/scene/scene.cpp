#include "core/scene/scene.h"

#include <fmt/format.h>

#include <cassert>
#include <numbers>

namespace rigor {
namespace {

Mat3 diagonal(double xx, double yy, double zz) { return Vec3(xx, yy, zz).asDiagonal(); }

struct SolidInertia {
  double mass;
  Mat3 operator()(const Sphere& s) const {
    const double i = 0.4 * mass * s.radius * s.radius;
    return diagonal(i, i, i);
  }
  Mat3 operator()(const Box& b) const {
    const Vec3 s = b.size.cwiseAbs2();
    return mass / 12.0 * diagonal(s.y() + s.z(), s.x() + s.z(), s.x() + s.y());
  }
  // A cylinder and two half-spheres; a half-sphere's centre of mass lies 3/8 r from its flat face, and its inertia
  // about a diameter of that face is 2/5 m r².
  Mat3 operator()(const Capsule& c) const {
    const double r = c.radius, h = c.length;
    const double cylinder_volume = std::numbers::pi * r * r * h, ball_volume = 4.0 / 3.0 * std::numbers::pi * r * r * r;
    const double mc = mass * cylinder_volume / (cylinder_volume + ball_volume), mb = mass - mc;
    const double axial = 0.5 * mc * r * r + 0.4 * mb * r * r;
    const double across = mc * (h * h / 12.0 + r * r / 4.0) + mb * (0.4 * r * r + h * h / 4.0 + 3.0 / 8.0 * h * r);
    return diagonal(across, across, axial);
  }
  Mat3 operator()(const Plane&) const {
    assert(false && "a plane has no inertia");
    return Mat3::Zero();
  }
};

const Vec3* first_of_kind(const Joint& joint, JointVector wanted) {
  const Vec3* found = nullptr;
  for_each_vector(joint.type, [&](const char*, JointVector kind, const Vec3& vector) {
    if (!found && kind == wanted) found = &vector;
  });
  return found;
}

}  // namespace

ContactLaw Scene::contact_law(int a, int b) const {
  for (const ContactPair& pair : contact_pairs) {
    if ((pair.a == a && pair.b == b) || (pair.a == b && pair.b == a)) return pair.law;
  }
  return contact_default;
}

std::string Scene::joint_name(std::size_t index) const {
  const Joint& joint = joints[index];
  if (!joint.name.empty()) return fmt::format("joint '{}'", joint.name);
  return fmt::format("the {} of '{}' and '{}'", joint_type_name(joint), body_name(joint.a), body_name(joint.b));
}

BodyPose Scene::pose(int body) const {
  return body == kWorld ? BodyPose{} : BodyPose{bodies[body].position, bodies[body].orientation};
}

Mat3 inertia_of(const Shape& shape, double mass) { return std::visit(SolidInertia{mass}, shape); }

std::string shape_name(const Shape& shape) { return kShapeWords[shape.index()]; }

std::string joint_type_name(const Joint& joint) { return joint_types()[joint.type.index()].word; }

bool turns(const Joint& joint) { return joint_types()[joint.type.index()].coordinate == FreeCoordinate::angle; }

const Vec3* anchor_of(const Joint& joint) { return first_of_kind(joint, JointVector::point); }

const Vec3* axis_of(const Joint& joint) { return first_of_kind(joint, JointVector::direction); }

const Vec3* free_axis(const Joint& joint) {
  return joint_types()[joint.type.index()].coordinate == FreeCoordinate::none ? nullptr : axis_of(joint);
}

}  // namespace rigor
