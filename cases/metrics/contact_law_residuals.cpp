// How far reported contacts are from two laws of rigid contact. Le Lidec et al. (Contact models in robotics: a
// comparative analysis, 2023) and Horak, Trinkle (On the similarities and differences among contact models in robot
// simulation, 2019) compare engines by such residuals.
//
// signorini_residual: 0 <= gap ⊥ f_n >= 0. A force acts only where the gap is closed, so gap × f_n must be zero. A
// positive gap under a force hovers; a negative one is an overlap that carries.
//
// dissipation_residual: friction takes the most power that its cone allows, f_t·u_t + mu f_n |u_t| = 0, with u_t the
// velocity of sliding at the step's end. Friction across the sliding, or none, leaves a positive power.
#include <cmath>

#include "cases/metrics/measures/contact/pair_forces.h"
#include "cases/metrics/measures/measuring.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline metric {
namespace {

// The largest value that `of` finds among the contacts of each sample after the first.
template <typename Of>
MetricResult largest_of_contacts(const JudgedRun& run, const Of& of) {
  if (const std::string why = why_no_contacts(run); !why.empty()) return {{}, why};
  TimeSeries series;
  for (const Sample& sample : run.trajectory.samples) {
    Instant worst{sample.time, kWorld, "contact", 0, 0};
    double largest = 0;
    for (const ReportedContact& contact : sample.contacts) {
      const Instant at = of(sample, contact);
      if (at.found <= largest) continue;
      largest = at.found, worst = at;
      worst.time = sample.time, worst.body = contact.b;
    }
    series.add(largest, worst);
  }
  return {std::move(series).finish(), ""};
}

MetricResult measure_signorini(const JudgedRun& run) {
  return largest_of_contacts(run, [](const Sample&, const ReportedContact& contact) {
    return Instant{0, kWorld, "gap times normal force", std::abs(contact.gap * contact.force.dot(contact.normal)), 0};
  });
}

MetricResult measure_dissipation(const JudgedRun& run) {
  const ContactLaws laws(run.scene);
  return largest_of_contacts(run, [&](const Sample& sample, const ReportedContact& contact) {
    const Vec3 n = contact.normal, slip = slip_of(contact, sample.bodies.columns()),
               friction = contact.force - n.dot(contact.force) * n;
    const double mu = laws.of(contact.a, contact.b).friction;
    const double most = std::isfinite(mu) ? mu * std::max(0.0, n.dot(contact.force)) * slip.norm() : 0;
    return Instant{0, kWorld, "power of friction", std::max(0.0, friction.dot(slip) + most), 0};
  });
}

}  // namespace

MetricRow dissipation_residual() {
  return {.name = "dissipation_residual",
          .unit = "W",
          .summary = "largest power by which reported friction brakes less than Coulomb's law, f_t u_t + mu f_n |u_t|",
          .measure = measure_dissipation,
          .needs = {.contacts = true}};
}

MetricRow signorini_residual() {
  return {.name = "signorini_residual",
          .unit = "N m",
          .summary = "largest product of a contact's reported gap and normal force, of which one must be zero",
          .measure = measure_signorini,
          .needs = {.contacts = true}};
}

}  // namespace rigor::inline metric
