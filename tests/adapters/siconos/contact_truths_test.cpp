// An independent check of the core's contact=event, by a program that shares no equation with it. Siconos steps over
// impacts and changes of sliding, with first order in dt, and must converge to the same motion as dt falls. It shares
// only the contact points.
#include <boost/test/unit_test.hpp>

#include "cases/case/suite.h"
#include "cases/truth/truth.h"
#include "tests/adapters/free_body_measures.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_siconos_contact_truths)

namespace {

double distance_from_truth(const Case& definition, const Truth& truth, double dt, double time) {
  const auto world = load_run("siconos", definition.scene);
  body_after(*world, dt, static_cast<int>(std::lround(time / dt)));
  Snapshot found;
  world->read(found);
  BodyTable due(definition.scene.bodies.size());
  truth.at(time, due.columns());
  double distance = 0;
  for (std::size_t i = 0; i < due.size(); ++i) {
    const BodyState a = found.bodies().body(i), b = due.columns().body(i);
    distance = std::max({distance, (a.position - b.position).norm(), angle_between(a.orientation, b.orientation)});
  }
  return distance;
}

struct Opinion {
  const char* id;
  double time;  // s, up to which it is asked
};

}  // namespace

BOOST_AUTO_TEST_CASE(siconos_comes_to_the_truth_as_its_step_falls) {
  for (const auto& [id, time] :
       {Opinion{"contact/toppling-box", 1}, {"contact/tumbling-box", 1}, {"contact/corbel-arch", 0.2}}) {
    const Case definition = select_cases({id}, default_suite_dir(), test::words()).front();
    const auto truth = make_truth(definition.truth, definition.scene, time);
    const double coarse = distance_from_truth(definition, *truth, 1.0 / 250, time),
                 fine = distance_from_truth(definition, *truth, 1.0 / 4000, time);
    BOOST_TEST_MESSAGE(id << ": " << coarse << " at 1/250 s, " << fine << " at 1/4000 s");
    BOOST_TEST(coarse > 1e-3, id);      // there is something to converge
    BOOST_TEST(fine < coarse / 8, id);  // a sixteenth of the step; half of what that makes in first order
    BOOST_TEST(fine < 1e-2, id);  // m, rad: what a truth that slides, sticks or bounces otherwise is off by is tenths
  }
}

BOOST_AUTO_TEST_CASE(what_stands_in_the_truth_stands_in_siconos) {
  const Case house = select_cases({"contact/card-house"}, default_suite_dir(), test::words()).front();
  const auto truth = make_truth(house.truth, house.scene, 0.5);
  const double found = distance_from_truth(house, *truth, 1.0 / 240, 0.5);
  BOOST_TEST_MESSAGE("card-house: " << found);
  BOOST_TEST(found < 1e-9);  // cards that gave way would go g t^2 / 2 = 1.2 m; the solver's 1e-12 over 120 steps
}

BOOST_AUTO_TEST_SUITE_END()
