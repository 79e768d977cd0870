// An independent check of the truth of contact/tumbling-box, without code of contact=event (micro_collisions.h). A box
// strikes the floor on one corner after another, slides, rocks and comes to rest.
#include <boost/test/unit_test.hpp>

#include "core/scene/contact_laws.h"
#include "tests/cases/suite/suite_checks.h"
#include "tests/cases/truth/solved/micro_collisions.h"

using namespace rigor;
using rigor::test::MicroCollisions;

BOOST_AUTO_TEST_SUITE(cases_truth_solved_tumbling_box)

namespace {

std::vector<BodyState> by_micro_collisions(const Scene& scene, double hop, const std::vector<double>& times) {
  const Body& body = scene.bodies[0];
  const ContactLaw law = ContactLaws(scene).of(0, 1);
  const MicroCollisions motion(
      {body.mass, 0.5 * std::get<Box>(*body.shape).size, -scene.gravity.z(), law.friction, law.restitution}, hop);
  MicroCollisions::Motion now{body.position, body.velocity, {}, body.orientation.normalized()};
  now.L = motion.momentum(now.q, body.angular_velocity);
  std::vector<BodyState> states;
  double t = 0;
  for (const double time : times) {
    motion.advance(now, time - t), t = time;
    states.push_back({now.x, now.q, now.v, Vec3::Zero()});
  }
  return states;
}

double distance(const BodyState& a, const BodyState& b) {
  return std::max((a.position - b.position).norm(), angle_between(a.orientation, b.orientation));
}

}  // namespace

// The blow at 1.064 s falls on an edge that slides. It is known to the truth's own error by the law that those corners
// that approach take their blows together; taken one after another, the box comes to lie 4 mm away.
BOOST_AUTO_TEST_CASE(impacts_alone_come_to_where_the_truth_is) {
  const Case c = select_cases({"contact/tumbling-box"}, default_suite_dir(), test::words()).at(0);
  const auto truth = make_truth(c.truth, c.scene, c.duration);
  const std::vector<double> times = {0.3, 0.5, 0.7, 0.9, 1, 1.05, 1.1};
  const auto coarse = by_micro_collisions(c.scene, 5e-5, times), fine = by_micro_collisions(c.scene, 2.5e-5, times);
  BodyTable state(c.scene.bodies.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    truth->at(times[i], state.columns());
    // First order in the hop: the remaining error is the change by half the hop, and as much again for the next order.
    const double own = 2 * distance(coarse[i], fine[i]);
    BOOST_TEST(own < 2e-5, times[i]);  // m: of 4 mm, which it must tell
    const double apart = distance(fine[i], std::as_const(state).columns().body(0));
    BOOST_TEST(apart <= truth->error(times[i]) + own,
               "at " << times[i] << " s: " << apart << " m or rad, of which " << own << " may be its own");
  }
}

BOOST_AUTO_TEST_SUITE_END()
