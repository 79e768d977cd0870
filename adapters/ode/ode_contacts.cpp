// How ODE's contacts are made from the scene's pair laws. A contact joint lives for one step; its friction limit
// follows the normal force of the step (dContactApprox1): without that flag mu is a force [N], not a coefficient.
#include <cmath>
#include <cstdint>

#include "adapters/ode/ode_world.h"

namespace rigor::inline adapters {
namespace {

constexpr int kMaxContacts = 64;       // of one pair; two boxes have at most eight, triangles any number
constexpr double kSlowest = 1e-9;      // m/s: below it a sliding velocity is rounding and has no direction
constexpr double kRollingSlip = 1e-6;  // m/s: far above what the solver leaves of the slip of a body that rolls

Vec3 contact_vector(const dReal* v) { return {v[0], v[1], v[2]}; }

Vec3 velocity_at(dBodyID body, const Vec3& point) {
  if (!body) return Vec3::Zero();
  const Vec3 arm = point - contact_vector(dBodyGetPosition(body));
  return contact_vector(dBodyGetLinearVel(body)) + contact_vector(dBodyGetAngularVel(body)).cross(arm);
}

// ODE's softness is a spring and damper, integrated by implicit Euler: its parameters depend on the step.
void soften(const ContactLaw& law, double dt, dSurfaceParameters& surface) {
  const double resists = dt * law.stiffness + law.damping;  // N s/m
  surface.mode |= dContactSoftERP | dContactSoftCFM;
  surface.soft_erp = dt * law.stiffness / resists;
  surface.soft_cfm = 1 / resists;
}

dSurfaceParameters surface_of(const ContactLaw& law) {
  dSurfaceParameters surface = {};
  // An infinite coefficient is its own limit; multiplied by a normal force of zero it would be no number.
  const bool infinite = law.friction == kInfiniteFriction;
  surface.mu = infinite ? dInfinity : law.friction;
  if (!infinite) surface.mode |= dContactApprox1;
  if (law.restitution > 0) {
    surface.mode |= dContactBounce;
    surface.bounce = law.restitution;
    surface.bounce_vel = 0;  // m/s: a threshold below which nothing would bounce
  }
  if (law.resists_turning()) {
    surface.mode |= dContactRolling | dContactAxisDep;  // the latter reads rho2, rhoN and mu2, too
    surface.mu2 = surface.mu;
    surface.rho = surface.rho2 = law.rolling_friction;
    surface.rhoN = law.torsional_friction;
  }
  return surface;
}

Vec3 angular_velocity_of(dBodyID body) { return body ? contact_vector(dBodyGetAngularVel(body)) : Vec3::Zero().eval(); }

// ODE's friction is a pyramid. Its first axis along the sliding velocity makes it act as the cone does while sliding.
// Rolling friction acts about the same axes: without sliding, the first is along the relative angular velocity.
void align_friction(dContact& contact, dBodyID a, dBodyID b) {
  const Vec3 point = contact_vector(contact.geom.pos), normal = contact_vector(contact.geom.normal);
  const Vec3 relative = velocity_at(a, point) - velocity_at(b, point);
  Vec3 sliding = relative - normal.dot(relative) * normal;
  if (contact.surface.rho > 0 && sliding.norm() < kRollingSlip) {
    const Vec3 turning = angular_velocity_of(a) - angular_velocity_of(b);
    sliding = turning - normal.dot(turning) * normal;
  }
  const double speed = sliding.norm();
  if (speed < kSlowest) return;
  contact.surface.mode |= dContactFDir1;
  for (int k = 0; k < 3; ++k) contact.fdir1[k] = sliding[k] / speed;
}

int index_of(dGeomID geom) { return static_cast<int>(reinterpret_cast<std::intptr_t>(dGeomGetData(geom))); }

}  // namespace

double OdeWorld::bounce_threshold() { return surface_of({.restitution = 1, .friction = 0}).bounce_vel; }

void OdeWorld::find_contacts() {
  reported_.clear();
  dSpaceCollide(moving_, this, &OdeWorld::touch);
  dSpaceCollide2(reinterpret_cast<dGeomID>(moving_), reinterpret_cast<dGeomID>(fixed_), this, &OdeWorld::touch);
}

void OdeWorld::touch(void* self, dGeomID a, dGeomID b) { static_cast<OdeWorld*>(self)->add_contacts(a, b); }

void OdeWorld::add_contacts(dGeomID a, dGeomID b) {
  if (!laws_.may_touch(index_of(a), index_of(b))) return;
  dContact found[kMaxContacts];
  const int count = dCollide(a, b, kMaxContacts, &found[0].geom, sizeof(dContact));
  if (count == 0) return;
  const ContactLaw& law = laws_.of(index_of(a), index_of(b));
  dSurfaceParameters surface = surface_of(law);
  if (contact_erp_ != dWorldGetERP(world_)) {  // which is then the joints' alone
    surface.mode |= dContactSoftERP;
    surface.soft_erp = contact_erp_;
  }
  if (law.is_soft()) soften(law, step_, surface);
  const dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
  for (int i = 0; i < count; ++i) {
    found[i].surface = surface;
    if (matched_ && surface.mu > 0) align_friction(found[i], body_a, body_b);
    const dJointID joint = dJointCreateContact(world_, contacts_, &found[i]);
    dJointAttach(joint, body_a, body_b);
    if (reports_contacts_) note_contact(joint, found[i].geom);
  }
}

// ODE's normal points into the first geometry.
void OdeWorld::note_contact(dJointID joint, const dContactGeom& found) {
  Reported& reported = reported_.emplace_back();
  const Vec3 point = contact_vector(found.pos), normal = -contact_vector(found.normal);
  reported = {{index_of(found.g1), index_of(found.g2), point, normal, -found.depth, Vec3::Zero()},
              dGeomGetBody(found.g1) != nullptr,
              dGeomGetBody(found.g2) != nullptr,
              {}};
  dJointSetFeedback(joint, &reported.feedback);
}

// In W. ODE's forces act for the whole of the step. The first of its two bodies is always one that moves.
std::vector<ReportedContact> OdeWorld::contacts() const {
  std::vector<ReportedContact> contacts;
  for (const auto& [contact, a_moves, b_moves, feedback] : reported_) {
    contacts.push_back(contact);
    contacts.back().force = !b_moves  ? Vec3(-contact_vector(feedback.f1))
                            : a_moves ? contact_vector(feedback.f2)
                                      : contact_vector(feedback.f1);
  }
  return contacts;
}

}  // namespace rigor::inline adapters
