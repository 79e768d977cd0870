// Soft contact: the force law of a pair is part of the equations of motion. Let x be the overlap of two spheres,
// or of a sphere and a plane. The force along the normal is max(0, k x + c x') (Kelvin and Voigt) or
// max(0, k x (1 + d x')) (Hunt and Crossley, J. Appl. Mech. 42, 1975). There is no friction. The integrator asks for
// the force at each of its stages. An integrator that does not ask for forces is replaced by rkmk4, or above order 4 by
// dormand-prince. The force begins and ends with a jump in its slope, or, with c > 0, in its value. Methods of fixed
// step lose their order there. dormand-prince shortens its steps until its tolerance is met. Every pair of spheres is
// looked at, so the method is for few bodies.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dynamics/contact/contact_method.h"
#include "core/dynamics/kernels/kernels.h"
#include "core/engine/columns.h"
#include "core/engine/engine_failure.h"
#include "core/engine/state_archive.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline dynamics {
namespace {

// A sphere, and another or a plane.
struct SoftPair {
  int ball, other;
  double radius, other_radius;  // m; a plane's is 0
  const Plane* plane;           // null for another sphere
  ContactLaw law;
};

std::vector<SoftPair> soft_pairs(const Scene& scene) {
  const ContactLaws laws(scene);
  std::vector<SoftPair> pairs;
  const auto radius_of = [&](int i) {
    const auto* sphere = std::get_if<Sphere>(&*scene.bodies[static_cast<std::size_t>(i)].shape);
    return sphere ? sphere->radius : 0;
  };
  const int count = static_cast<int>(scene.bodies.size());
  for (int a = 0; a < count; ++a) {
    for (int b = a + 1; b < count; ++b) {
      const Body &body_a = scene.bodies[static_cast<std::size_t>(a)],
                 &body_b = scene.bodies[static_cast<std::size_t>(b)];
      if (!can_meet(body_a, body_b) || !laws.may_touch(a, b)) continue;
      const auto *plane_a = std::get_if<Plane>(&*body_a.shape), *plane_b = std::get_if<Plane>(&*body_b.shape);
      const int ball = plane_a ? b : a, other = plane_a ? a : b;
      if (!laws.of(a, b).is_soft()) {
        throw EngineFailure(FailureKind::unsupported,
                            fmt::format("contact=soft has no rigid contact, and that of '{}' and '{}' is one",
                                        body_a.name, body_b.name));
      }
      pairs.push_back({ball, other, radius_of(ball), radius_of(other), plane_a ? plane_a : plane_b, laws.of(a, b)});
    }
  }
  return pairs;
}

class SoftForces : public ConstraintForces {
 public:
  SoftForces(const Scene& scene, const System& system)
      : system_(system), pairs_(soft_pairs(scene)), wrenches_(kWrenchColumns, system.size()) {}

  const double* hold(BodyColumns state, const double* wrench, Rows) override {
    for (std::size_t c = 0; c < kWrenchColumns; ++c) {
      double* const to = wrenches_.column(c);
      if (wrench)
        std::copy_n(wrench + c * wrenches_.stride(), system_.size(), to);
      else
        std::fill_n(to, system_.size(), 0.0);
    }
    for (const SoftPair& pair : pairs_) add(pair, state);
    return wrenches_.data();
  }

  // The least radius of a sphere that others can pass; infinite without such.
  double least_radius() const {
    double least = std::numeric_limits<double>::infinity();
    for (const SoftPair& pair : pairs_)
      if (!pair.plane) least = std::min({least, pair.radius, pair.other_radius});
    return least;
  }

 private:
  // The force acts along the line of centres, so it has no torque.
  void add(const SoftPair& pair, BodyColumns state) {
    const auto ball = static_cast<std::size_t>(pair.ball), other = static_cast<std::size_t>(pair.other);
    Vec3 n;  // towards the ball
    double overlap = 0;
    if (pair.plane) {
      n = pair.plane->normal;
      overlap = pair.radius - (n.dot(state.position(ball)) - pair.plane->offset);
    } else {
      const Vec3 line = state.position(ball) - state.position(other);
      const double distance = line.norm();
      overlap = pair.radius + pair.other_radius - distance;
      if (distance == 0) return;  // no direction to part in
      n = line / distance;
    }
    if (!(overlap > 0)) return;
    const double closing = -n.dot(state.velocity(ball) - (pair.plane ? Vec3::Zero() : Vec3(state.velocity(other))));
    const ContactLaw& law = pair.law;
    const double force =
        std::max(0.0, law.stiffness * overlap * (1 + law.dissipation * closing) + law.damping * closing);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      wrenches_.column(kForce + k)[ball] += force * n[axis];
      if (!pair.plane) wrenches_.column(kForce + k)[other] -= force * n[axis];
    }
  }

  const System& system_;
  std::vector<SoftPair> pairs_;
  Columns wrenches_;
};

class SoftStepper : public ContactStepper {
 public:
  SoftStepper(const Scene& scene, const ContactParts& parts)
      : system_(parts.system),
        forces_(scene, parts.system),
        least_radius_(forces_.least_radius()),
        in_contact_(asking(parts.integrator)),
        integrator_(
            in_contact_.make({parts.system, nullptr, parts.orientation, parts.settings, nullptr, nullptr, &forces_})) {}

  void step(MutableBodyColumns state, double t, double dt) override {
    const int count = parts_of(state, dt);
    sub_step_ = count > 1 ? std::optional(dt / count) : std::nullopt;
    for (int k = 0; k < count; ++k) integrator_->step(state, t + k * (dt / count), dt / count);
  }

  std::string solver_warning() const override { return integrator_->solver_warning(); }
  void archive_state(StateArchive& archive) override {
    archive(sub_step_);
    integrator_->archive_state(archive);
  }
  std::optional<double> sub_step() const override { return sub_step_; }
  SettingsInForce settings_in_force() const override {
    return {{"integrator in contact", in_contact_.name},
            {"contact law", "max(0, k x (1 + d x') + c x'), at each stage"}};
  }

 private:
  static const Integrator& asking(const Integrator& own) {
    if (own.holds_at_stages) return own;
    return integrator(own.order <= 4 ? "rkmk4" : "dormand-prince");
  }

  // Two spheres must not pass through each other between two stages: no part moves any by more than a quarter of the
  // least radius.
  int parts_of(BodyColumns state, double dt) const {
    constexpr double kShare = 0.25, kMost = 1e5;
    double fastest = 0;
    for (std::size_t i = 0; i < state.size(); ++i) fastest = std::max(fastest, state.velocity(i).norm());
    const double way = dt * (fastest + dt * system_.scene_gravity.norm());
    return std::max(1, static_cast<int>(std::min(kMost, std::ceil(way / (kShare * least_radius_)))));
  }

  const System& system_;
  SoftForces forces_;
  double least_radius_;
  const Integrator& in_contact_;
  std::unique_ptr<Stepper> integrator_;
  std::optional<double> sub_step_;
};

}  // namespace

extern const ContactMethod kSoftContact;
const ContactMethod kSoftContact = {
    .name = "soft",
    .summary = "the springs and dampers of soft contacts at each stage; for a few spheres without friction",
    .features = {contact_feature<Plane, Sphere>(), contact_feature<Sphere, Sphere>(), Feature::soft_contact,
                 Feature::hunt_crossley, Feature::contact_filter, Feature::friction_none},
    .make = make_contact_stepper<SoftStepper>,
};

}  // namespace rigor::inline dynamics
