#include "adapters/siconos/process/siconos_contacts.h"

#include <Interaction.hpp>
#include <NewtonEuler3DR.hpp>
#include <NewtonImpactFrictionNSL.hpp>
#include <SiconosVector.hpp>
#include <Simulation.hpp>
#include <algorithm>
#include <cmath>

namespace rigor::inline adapters::siconos {

namespace {

// Of a point in W, in a body's frame; in W itself for a body that is fixed, which Siconos does not know.
Vec3 in_frame(BodyColumns state, int body, bool is_fixed, const Vec3& point) {
  const auto i = static_cast<std::size_t>(body);
  return is_fixed ? point : state.orientation(i).conjugate() * (point - state.position(i));
}

}  // namespace

// A point of one body, and the point of the other (or of the world) that it would meet, each in its frame.
class ContactPoint : public NewtonEuler3DR {
 public:
  void set(const Vec3& on_a, const Vec3& on_b, const Vec3& normal) {
    setRelPc1(vector_of(on_a)), setRelPc2(vector_of(on_b)), setRelNc(vector_of(normal));
  }
  // The gap along the normal, m.
  void computeh(double time, const BlockVector& q, SiconosVector& y) override {
    NewtonEuler1DR::computeh(time, q, y);
    double gap = 0;
    for (int k = 0; k < 3; ++k) gap += (*_Nc)(k) * ((*_Pc1)(k) - (*_Pc2)(k));
    y.setValue(0, gap);
  }
  // At the last step's end. Siconos has the bodies in the same order, the normal towards the first, and in `lambda` the
  // impulse along the rows of the contact's frame.
  ReportedContact report(const SiconosVector& lambda, double dt) const {
    ReportedContact found;
    for (unsigned k = 0; k < 3; ++k) {
      found.point[k] = 0.5 * ((*_Pc1)(k) + (*_Pc2)(k));
      found.normal[k] = -(*_Nc)(k);
      found.gap += (*_Nc)(k) * ((*_Pc1)(k) - (*_Pc2)(k));
      for (unsigned row = 0; row < 3; ++row) found.force[k] -= (*_jachqT)(row, k) * lambda(row) / dt;
    }
    return found;
  }
};

Contacts::Contacts(const Scene& scene, Bodies& bodies)
    : laws_(scene), bodies_(bodies), is_needed_(anything_can_touch(scene)) {
  if (is_needed_) colliders_ = colliders_of(scene);
  boxes_.resize(colliders_.size());
}

double Contacts::reach(int body) const {
  const auto i = static_cast<std::size_t>(body);
  const auto found =
      std::find_if(colliders_.begin(), colliders_.end(), [&](const Collider& c) { return c.body == body; });
  if (found->fixed) return 0;
  const double speed =
      bodies_.state().velocity(i).norm() + found->bounding_radius * bodies_.state().angular_velocity(i).norm();
  return 2 * dt_ * speed + 0.05 * found->inradius;
}

void Contacts::updateInteractions(SP::Simulation simulation) {
  bodies_.gather();
  for (auto& [key, kept] : kept_) kept.is_seen = false;
  for (std::size_t n = 0; n < colliders_.size(); ++n)
    boxes_[n] = aabb_of(colliders_[n].shape, pose_of(bodies_.state(), colliders_[n].body), reach(colliders_[n].body));
  for (const auto& [first, second] : broad_phase_.overlaps(boxes_)) {
    const Collider &a = colliders_[static_cast<std::size_t>(first)], &b = colliders_[static_cast<std::size_t>(second)];
    if ((a.fixed && b.fixed) || !laws_.may_touch(a.body, b.body)) continue;
    a.fixed ? meet(b, a, *simulation) : meet(a, b, *simulation);
  }
  for (auto it = kept_.begin(); it != kept_.end();) {
    if (!it->second.is_seen) simulation->unlink(it->second.interaction);
    it = it->second.is_seen ? std::next(it) : kept_.erase(it);
  }
}

void Contacts::add_forces(double dt, std::vector<ReportedContact>& contacts) const {
  for (const auto& [key, kept] : kept_) {
    ReportedContact found = kept.point->report(*kept.interaction->lambda(1), dt);
    found.a = static_cast<int>(key[0]), found.b = static_cast<int>(key[1]);
    contacts.push_back(found);
  }
}

// `a` moves.
void Contacts::meet(const Collider& a, const Collider& b, Simulation& simulation) {
  manifold_.clear();
  collide(a.shape, pose_of(bodies_.state(), a.body), b.shape, pose_of(bodies_.state(), b.body), manifold_);
  const double most = reach(a.body) + reach(b.body);
  for (const ManifoldPoint& point : manifold_)
    if (point.gap <= most) keep(a.body, b.body, point, simulation);
}

void Contacts::keep(int a, int b, const ManifoldPoint& point, Simulation& simulation) {
  const BodyColumns state = bodies_.state();
  const auto& system_a = bodies_.systems()[static_cast<std::size_t>(a)];
  const auto& system_b = bodies_.systems()[static_cast<std::size_t>(b)];
  const Vec3 half = 0.5 * point.gap * point.normal;
  const Vec3 normal =
      system_b ? Vec3(state.orientation(static_cast<std::size_t>(b)).conjugate() * point.normal) : point.normal;
  Kept& kept = kept_[{static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), point.feature}];
  const bool is_new = !kept.point;
  if (is_new) kept.point = std::make_shared<ContactPoint>();
  kept.point->set(in_frame(state, a, false, point.point + half), in_frame(state, b, !system_b, point.point - half),
                  normal);
  kept.is_seen = true;
  if (!is_new) return;
  const ContactLaw& law = laws_.of(a, b);
  const auto nslaw = std::make_shared<NewtonImpactFrictionNSL>(law.restitution, 0.0, law.friction, 3);
  kept.interaction = std::make_shared<Interaction>(nslaw, kept.point);
  system_b ? simulation.link(kept.interaction, system_a, system_b) : simulation.link(kept.interaction, system_a);
}

}  // namespace rigor::inline adapters::siconos
