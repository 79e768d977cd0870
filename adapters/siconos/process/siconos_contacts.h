// Contact points for Siconos, found by Rigor's narrow phase. Siconos's own collision detection is Bullet's in single
// precision, with planes as slabs of 1000 m and boxes with rounded edges. Siconos applies the contact laws: Newton's
// restitution and Coulomb's cone.
#pragma once

#include <InteractionManager.hpp>
#include <map>
#include <memory>
#include <vector>

#include "adapters/siconos/process/siconos_bodies.h"
#include "core/dynamics/collision/broad_phase.h"
#include "core/engine/capabilities.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline adapters::siconos {

class ContactPoint;

class Contacts : public InteractionManager {
 public:
  Contacts(const Scene& scene, Bodies& bodies);

  bool is_needed() const { return is_needed_; }
  void set_step(double dt) { dt_ = dt; }  // s
  // Called by Siconos in each step, behind a first guess of the positions at its end.
  void updateInteractions(SP::Simulation simulation) override;
  // Adds what its contacts carried in the step that Siconos has just computed, as means over `dt` [s].
  void add_forces(double dt, std::vector<ReportedContact>& contacts) const;
  void forget() { kept_.clear(); }  // of a simulation that is no more

 private:
  struct Kept {
    SP::Interaction interaction;
    std::shared_ptr<ContactPoint> point;
    bool is_seen;
  };
  using Key = std::array<std::uint32_t, 3>;  // two bodies and a feature
  double reach(int body) const;              // m: how far it may come in a step, and a little more
  void meet(const Collider& a, const Collider& b, Simulation& simulation);
  void keep(int a, int b, const ManifoldPoint& point, Simulation& simulation);

  const ContactLaws laws_;
  Bodies& bodies_;
  std::vector<Collider> colliders_;
  std::vector<Aabb> boxes_;
  BroadPhase broad_phase_;
  Manifold manifold_;
  std::map<Key, Kept> kept_;
  double dt_ = 0;
  bool is_needed_;
};

}  // namespace rigor::inline adapters::siconos
