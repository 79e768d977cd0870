// Restitution, friction, and where surfaces are.
#include <algorithm>
#include <cmath>

#include "adapters/faults/changes.h"
#include "adapters/faults/faults.h"

namespace rigor::inline adapters {
namespace {

using namespace faulty;

template <typename F>
std::function<void(Scene&)> each_law(F change) {
  return [change](Scene& scene) {
    change(scene.contact_default);
    for (ContactPair& pair : scene.contact_pairs) change(pair.law);
  };
}

void grow_shape(Shape& shape, double by) {
  std::visit(
      ForShapes{[=](Box& box) { box.size += Vec3::Constant(2 * by); }, [=](Capsule& capsule) { capsule.radius += by; },
                [=](Compound& compound) {
                  for (PlacedShape& part : compound.parts) grow_shape(part.shape, by);
                },
                [=](Cylinder& cylinder) { cylinder.radius += by, cylinder.length += 2 * by; }, [](Plane&) {},
                [](Mesh&) {}, [](Heightfield&) {}, [=](Sphere& sphere) { sphere.radius += by; },
                [&](auto&) { shape = scaled_shape(shape, 1 + by / inradius(shape)); }},
      shape);
}

void grow(Body& body, double by) {
  if (body.shape) grow_shape(*body.shape, by);
}

template <typename F>
std::function<void(Scene&)> each_plane(F change) {
  return each_body([change](Body& body) {
    if (!body.shape) return;
    if (auto* plane = std::get_if<Plane>(&*body.shape)) change(*plane);
  });
}

// The plane's friction on a body that slides at the angle a to the first of two axes in the plane, if each axis has its
// own limit mu N. Together they brake with mu N / max(|cos a|, |sin a|), along the diagonal with sqrt(2) mu N.
double of_pyramid(const ContactLaw& law, const Body& body, const Plane& plane) {
  const Vec3 first = plane.normal.unitOrthogonal(), second = plane.normal.cross(first);
  const double along = std::abs(first.dot(body.velocity)), across = std::abs(second.dot(body.velocity));
  const double speed = std::hypot(along, across);
  return speed > 0 ? law.friction * speed / std::max(along, across) : law.friction;
}

// Uses the velocities at the start: where bodies slide straight, their directions do not change.
void friction_as_pyramid(Scene& scene) {
  std::vector<ContactPair> pairs = scene.contact_pairs;
  for (int ground = 0; ground < static_cast<int>(scene.bodies.size()); ++ground) {
    const auto& shape = scene.bodies[ground].shape;
    const auto* plane = shape ? std::get_if<Plane>(&*shape) : nullptr;
    for (int i = 0; plane && i < static_cast<int>(scene.bodies.size()); ++i) {
      if (scene.bodies[i].fixed) continue;
      ContactLaw law = scene.contact_law(i, ground);
      law.friction = of_pyramid(law, scene.bodies[i], *plane);
      std::erase_if(pairs, [&](const ContactPair& p) { return std::minmax(p.a, p.b) == std::minmax(i, ground); });
      pairs.push_back({i, ground, law});
    }
  }
  scene.contact_pairs = pairs;
}

// m: from the body's centre to its farthest point along a unit direction; 0 for a plane.
double reach_along(const Vec3& direction, const Body& body) {
  if (!body.shape || std::holds_alternative<Plane>(*body.shape)) return 0;
  const Vec3 n = matrix_of(body.orientation).transpose() * direction;
  return n.dot(support(*body.shape, n));
}

// Friction on a sphere or box that slides on a plane acts against the slip of the step before. The engine's own
// friction acts against the present slip, so the body gets the difference as an impulse. The normal force is the
// weight's part.
void turn_friction_late(Moment& moment, std::size_t i, int ground, const Plane& plane) {
  constexpr double kTouching = 1e-3;  // m: deeper than engines let a body at rest sink, or float
  Body& body = moment.scene.bodies[i];
  const double height = plane.normal.dot(body.position) - plane.offset;
  if (body.fixed || std::abs(height - reach_along(plane.normal, body)) > kTouching) return;
  const double braking = moment.scene.contact_law(static_cast<int>(i), ground).friction *
                         std::max(0.0, -moment.scene.gravity.dot(plane.normal)) * moment.dt;  // m/s in this step
  const auto slip = [&](const Vec3& velocity, const Vec3& spin) {
    const Vec3 all = velocity - height * spin.cross(plane.normal);
    return Vec3(all - all.dot(plane.normal) * plane.normal);
  };
  const Vec3 now = slip(body.velocity, body.angular_velocity),
             old = slip(moment.before.velocity(i), moment.before.angular_velocity(i));
  constexpr double kGoesOn = 4;  // a sphere's slip shrinks by 3.5 times that speed; a slower one may stop in this step
  if (std::min(now.norm(), old.norm()) < kGoesOn * braking) return;
  const Vec3 point_B = body.orientation.conjugate() * (-height * plane.normal);
  push(body, body.mass * braking * (now.normalized() - old.normalized()), point_B);
}

void friction_direction_late(Moment& moment) {
  for (std::size_t ground = 0; ground < moment.scene.bodies.size(); ++ground) {
    const auto& shape = moment.scene.bodies[ground].shape;
    const auto* plane = shape ? std::get_if<Plane>(&*shape) : nullptr;
    for (std::size_t i = 0; plane && i < moment.scene.bodies.size(); ++i)
      turn_friction_late(moment, i, static_cast<int>(ground), *plane);
  }
}

void shorten_capsule(Body& body) {
  if (!body.shape) return;
  if (auto* capsule = std::get_if<Capsule>(&*body.shape)) capsule->length *= 1e-3;
}

template <typename F>
Fault law_fault(const std::string& name, F change) {
  return on_loading(name, each_law(change));
}

}  // namespace

std::vector<Fault> contact_faults() {
  return {
      law_fault("restitution squared", [](ContactLaw& l) { l.restitution *= l.restitution; }),
      law_fault("restitution left out", [](ContactLaw& l) { l.restitution = 0; }),
      law_fault("every contact elastic", [](ContactLaw& l) { l.restitution = 1; }),
      law_fault("friction halved", [](ContactLaw& l) { l.friction *= 0.5; }),
      law_fault("friction left out", [](ContactLaw& l) { l.friction = 0; }),
      law_fault("friction doubled", [](ContactLaw& l) { l.friction *= 2; }),
      on_loading("a pair's own law ignored", [](Scene& s) { s.contact_pairs.clear(); }),
      on_loading("contact left out", each_body([](Body& b) { b.collides = false; })),
      on_loading("friction as a pyramid", friction_as_pyramid),
      on_stepping("late-friction-direction", friction_direction_late),
      by_amount("contact offset by {} mm", 1,
                [](double mm) { return on_loading("", each_body([=](Body& b) { grow(b, 1e-3 * mm); })); }),
      on_loading("contact 1 mm too deep", each_body([](Body& b) { grow(b, -1e-3); })),
      by_amount("ground {} mm too high", 1,
                [](double mm) { return on_loading("", each_plane([=](Plane& plane) { plane.offset += 1e-3 * mm; })); }),
      on_loading("contact normal flipped", each_plane([](Plane& p) { p.normal *= -1; })),
      on_loading("capsule without its cylinder", each_body(shorten_capsule)),
      on_loading("every mass the same in contact", equal_masses),
      on_loading("inertia of a rolling body off by half", each_body([](Body& b) { b.inertia *= 1.5; })),
  };
}

}  // namespace rigor::inline adapters
