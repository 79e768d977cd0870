#include "tests/faults/contact_faults.h"

#include <algorithm>
#include <cmath>

#include "tests/faults/scene_faults.h"

namespace rigor::test {
namespace {

template <typename F>
std::function<void(Scene&)> each_law(F change) {
  return [change](Scene& scene) {
    change(scene.contact_default);
    for (ContactPair& pair : scene.contact_pairs) change(pair.law);
  };
}

void grow(Body& body, double by) {
  if (!body.shape) return;
  if (auto* sphere = std::get_if<Sphere>(&*body.shape)) sphere->radius += by;
  if (auto* box = std::get_if<Box>(&*body.shape)) box->size += Vec3::Constant(2 * by);
  if (auto* capsule = std::get_if<Capsule>(&*body.shape)) capsule->radius += by;
}

template <typename F>
std::function<void(Scene&)> each_plane(F change) {
  return each_body([change](Body& body) {
    if (!body.shape) return;
    if (auto* plane = std::get_if<Plane>(&*body.shape)) change(*plane);
  });
}

// The plane's friction on a body that slides at the angle a to the first of two axes in the plane, when each axis has
// its own limit mu N: together they brake with mu N / max(|cos a|, |sin a|), along the diagonal with sqrt(2) mu N.
double of_pyramid(const ContactLaw& law, const Body& body, const Plane& plane) {
  const Vec3 first = plane.normal.unitOrthogonal(), second = plane.normal.cross(first);
  const double along = std::abs(first.dot(body.velocity)), across = std::abs(second.dot(body.velocity));
  const double speed = std::hypot(along, across);
  return speed > 0 ? law.friction * speed / std::max(along, across) : law.friction;
}

// By the velocities at the start: where bodies slide straight, their directions do not change.
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

}  // namespace

std::vector<Fault> contact_faults() {
  const std::string bounce = "restitution_error|position_error|energy_gain|impact_time_error",
                    slide = "stop_distance_error|position_error|creep", place = "creep|penetration";
  return {
      {"restitution squared", "contact/pair-impact-0.5", bounce,
       each_law([](ContactLaw& l) { l.restitution *= l.restitution; })},
      {"restitution left out", "contact/pair-impact-0.75", bounce, each_law([](ContactLaw& l) { l.restitution = 0; })},
      {"every contact elastic", "contact/bounce-half", bounce, each_law([](ContactLaw& l) { l.restitution = 1; })},
      {"friction halved", "contact/sliding-stop", slide, each_law([](ContactLaw& l) { l.friction *= 0.5; })},
      {"friction left out", "contact/slide-to-roll", slide, each_law([](ContactLaw& l) { l.friction = 0; })},
      {"friction doubled", "contact/slope-slides", slide, each_law([](ContactLaw& l) { l.friction *= 2; })},
      {"a pair's own law ignored", "contact/sliding-stop", slide, [](Scene& s) { s.contact_pairs.clear(); }},
      {"contact left out", "contact/collision", bounce, each_body([](Body& b) { b.collides = false; })},
      {"friction as a pyramid", "contact/friction-fan", "friction_anisotropy", friction_as_pyramid},
      {"contact offset by 1 mm", "contact/lying-still", place, each_body([](Body& b) { grow(b, 1e-3); })},
      {"contact 1 mm too deep", "contact/lying-still", place, each_body([](Body& b) { grow(b, -1e-3); })},
      {"ground 1 mm too high", "contact/lying-still", place, each_plane([](Plane& p) { p.offset += 1e-3; })},
      {"contact normal flipped", "contact/collision", bounce, each_plane([](Plane& p) { p.normal *= -1; })},
      {"capsule without its cylinder", "contact/capsules-end-on", bounce, each_body([](Body& b) {
         if (b.shape) {
           if (auto* c = std::get_if<Capsule>(&*b.shape)) c->length *= 1e-3;
         }
       })},
      {"every mass the same in contact", "contact/capsules-end-on", bounce, equal_masses},
      {"inertia of a rolling body off by half", "contact/slide-to-roll", slide,
       each_body([](Body& b) { b.inertia *= 1.5; })},
  };
}

}  // namespace rigor::test
