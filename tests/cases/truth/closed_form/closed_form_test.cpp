#include "cases/truth/closed_form/closed_form.h"

#include <boost/test/unit_test.hpp>

#include "cases/case/suite.h"
#include "cases/truth/distance.h"
#include "core/base/error.h"
#include "core/dynamics/model/energy.h"
#include "tests/cases/truth/closed_form/smooth/smooth_scenes.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;
using test::SmoothScene;
using test::truth_at;

BOOST_AUTO_TEST_SUITE(cases_truth_closed_form_closed_form)

namespace {

// The distance of two states, each part relative to its scale: positions and velocities to the largest of their body's,
// angles to a radian.
double relative_distance(BodyColumns a, BodyColumns b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(
        {largest, (a.position(i) - b.position(i)).norm() / std::max(1.0, b.position(i).norm()),
         angle_between(a.orientation(i), b.orientation(i)),
         (a.velocity(i) - b.velocity(i)).norm() / std::max(1.0, b.velocity(i).norm()),
         (a.angular_velocity(i) - b.angular_velocity(i)).norm() / std::max(1.0, b.angular_velocity(i).norm())});
  }
  return largest;
}

void check_against_reference(const SmoothScene& row) {
  const auto closed = make_truth(row.truth, row.scene, row.duration);
  const auto solved = make_truth("reference", row.scene, row.duration);
  double worst = 0, worst_excess = 0, when = 0;
  constexpr int kSamples = 37;
  for (int n = 0; n <= kSamples; ++n) {
    const double t = row.duration * n / kSamples;
    const BodyTable a = truth_at(*closed, t, row.scene.bodies.size()),
                    b = truth_at(*solved, t, row.scene.bodies.size());
    const double apart = relative_distance(a.columns(), b.columns());
    if (apart > worst) worst = apart, when = t;
    worst_excess =
        std::max(worst_excess, distance_between(a.columns(), b.columns()) / (closed->error(t) + solved->error(t)));
  }
  BOOST_TEST_MESSAGE(row.truth << ", " << row.label << ": " << worst << " at " << when << " s; " << worst_excess
                               << " of the errors' sum, " << closed->error(row.duration) << " + "
                               << solved->error(row.duration));
  BOOST_TEST_CONTEXT(row.truth << ", " << row.label) {
    BOOST_TEST(worst < 1e-11);  // what the truths promise of each other
    BOOST_TEST(worst_excess <= 1);
  }
}

// To 1e-12 of what is exchanged: where a potential energy passes zero the sum alone would be no measure.
void check_conservation(const SmoothScene& row, const Truth& truth) {
  const std::size_t bodies = row.scene.bodies.size();
  const BodyTable first = truth_at(truth, 0, bodies);
  const BodyColumns start = first.columns();
  const bool is_free = row.scene.springs.empty() && row.scene.forces.empty();
  for (int n = 1; n <= 100; ++n) {
    const double t = row.duration * n / 100;
    const BodyTable table = truth_at(truth, t, bodies);
    const BodyColumns now = table.columns();
    if (row.keeps_energy) {
      const double scale = kinetic_energy(row.scene, now) + std::abs(potential_energy(row.scene, now));
      BOOST_TEST(std::abs(energy(row.scene, now) - energy(row.scene, start)) <= 1e-12 * scale);
    }
    if (!is_free) continue;
    const Vec3 pushed = row.scene.bodies[0].mass * t * row.scene.gravity, p = linear_momentum(row.scene, now);
    BOOST_TEST((p - linear_momentum(row.scene, start) - pushed).norm() <= 1e-12 * (p.norm() + pushed.norm()));
    const Vec3 L = angular_momentum(row.scene, now, now.position(0));
    BOOST_TEST((L - angular_momentum(row.scene, start, start.position(0))).norm() <= 1e-12 * L.norm());
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_closed_form_agrees_with_the_reference) {
  for (const SmoothScene& row : test::smooth_scenes()) check_against_reference(row);
}

BOOST_AUTO_TEST_CASE(so_does_that_of_every_case_of_the_suite_that_has_both) {
  int both = 0;
  for (const Case& c : select_cases({}, default_suite_dir(), test::words())) {
    if (c.truth == "none" || c.truth == "reference" || !c.scene.joints.empty()) continue;
    bool has_contacts = false;
    for (const Body& body : c.scene.bodies) has_contacts |= body.collides;
    if (has_contacts) continue;
    ++both;
    check_against_reference({c.truth, c.id, c.scene, c.duration});
  }
  BOOST_TEST(both > 0);
}

BOOST_AUTO_TEST_CASE(energy_and_momenta_stay_what_they_were) {
  for (const SmoothScene& row : test::smooth_scenes()) {
    for (const std::string& kind : {row.truth, std::string("reference")}) {
      BOOST_TEST_CONTEXT(kind << ", " << row.truth << ", " << row.label)
      check_conservation(row, *make_truth(kind, row.scene, row.duration));
    }
  }
}

BOOST_AUTO_TEST_CASE(the_error_never_falls_and_is_small) {
  for (const SmoothScene& row : test::smooth_scenes()) {
    const auto truth = make_truth(row.truth, row.scene, row.duration);
    double before = 0;
    for (int n = 0; n <= 200; ++n) {
      const double now = truth->error(row.duration * n / 200);
      BOOST_TEST_CONTEXT(row.truth << ", " << row.label) BOOST_TEST(now >= before);
      before = now;
    }
    // 1e-9 from the separatrix even quadruple precision leaves only fourteen digits of the square of k'.
    BOOST_TEST_CONTEXT(row.truth << ", " << row.label) BOOST_TEST(before < 1e-10);
  }
}

BOOST_AUTO_TEST_CASE(a_scene_with_what_it_does_not_know_is_refused_with_the_reason) {
  Scene sprung = test::fixed_spring(), touching = test::dropped_sphere(1);
  for (const char* name : {"asymmetric-top", "axisymmetric-top", "principal-torque", "projectile"}) {
    BOOST_CHECK_EXCEPTION(make_truth(name, sprung, 1), InputError, test::says("this scene has spring"));
    BOOST_CHECK_EXCEPTION(make_truth(name, touching, 1), InputError, test::says("may touch"));
  }
  for (const char* name : {"oscillator", "steady-precession"}) {
    BOOST_CHECK_EXCEPTION(make_truth(name, touching, 1), InputError, test::says("may touch"));
    BOOST_CHECK_EXCEPTION(make_truth(name, test::torqued(), 1), InputError, test::says("this scene has timed-force"));
  }
}

BOOST_AUTO_TEST_SUITE_END()
