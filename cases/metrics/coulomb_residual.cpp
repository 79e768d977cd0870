// How far a reported contact force is outside Coulomb's cone, |f_t| <= mu f_n: the larger of |f_t| - mu f_n and the
// pull -f_n. Horak, Trinkle (On the similarities and differences among contact models in robot simulation, 2019) and Le
// Lidec et al. (Contact models in robotics, 2023) compare engines by such residuals.
#include "cases/metrics/measures/contact/pair_forces.h"
#include "cases/metrics/measures/measuring.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline metric {
namespace {

// The coefficient of a point. A point that does not slide has its static friction; so has one that slides only at the
// step's end, because its force is the mean over the step.
double friction_of(const ReportedContact& contact, const ContactLaw& law, const Sample& sample, const Sample* before) {
  constexpr double kSlides = 1e-3;  // m/s; friction that is regularised creeps where it holds
  if (!law.sticks_better()) return law.friction;
  const bool slides = before && slip_of(contact, before->bodies.columns()).norm() > kSlides &&
                      slip_of(contact, sample.bodies.columns()).norm() > kSlides;
  return slides ? law.friction : law.static_friction;
}

MetricResult measure_coulomb(const JudgedRun& run) {
  if (const std::string why = why_no_contacts(run); !why.empty()) return {{}, why};
  const ContactLaws laws(run.scene);
  TimeSeries series;
  const Sample* before = nullptr;
  for (const Sample& sample : run.trajectory.samples) {
    double largest = 0;
    Instant worst{sample.time, kWorld, "force", 0, 0};
    for (const ReportedContact& contact : sample.contacts) {
      const double friction = friction_of(contact, laws.of(contact.a, contact.b), sample, before),
                   normal = contact.force.dot(contact.normal),
                   tangential = (contact.force - normal * contact.normal).norm();
      const double allowed = friction == kInfiniteFriction ? tangential : friction * normal;
      const double outside = std::max(tangential - allowed, -normal);
      if (outside <= largest) continue;
      largest = outside;
      worst = {sample.time, contact.b, "tangential force", tangential, allowed};
    }
    series.add(largest, worst);
    before = &sample;
  }
  return {std::move(series).finish(), ""};
}

}  // namespace

MetricRow coulomb_residual() {
  return {.name = "coulomb_residual",
          .unit = "N",
          .summary = "farthest that a reported contact force is outside the cone of friction",
          .measure = measure_coulomb,
          .needs = {.contacts = true}};
}

}  // namespace rigor::inline metric
