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

// The friction with which a box on a plane that leans towards (x, y) speeds up between 0.5 s and 1 s.
double friction_on_slope(const Vec3& lean, double friction) {
  Scene scene = sliding_box(0, 0, friction);
  const Vec3 normal = (Vec3::UnitZ() + lean).normalized();
  scene.bodies[0].position = 0.1 * normal;
  scene.bodies[0].orientation = Quat::FromTwoVectors(Vec3::UnitZ(), normal);
  scene.bodies[1].shape = Plane{normal, 0};
  const auto world = load_run("siconos", scene);
  const double early = body_after(*world, 1.0 / 240, 120).velocity.norm(),
               late = body_after(*world, 1.0 / 240, 120).velocity.norm();
  const double g = -scene.gravity.z(), along = g * std::hypot(normal.x(), normal.y());
  return (along - (late - early) / 0.5) / (g * normal.z());
}

// The same by Siconos's own frame. Its orthoBaseFromVector (op3x3.h) takes (0, -n_z, n_x) as the first tangent of a
// normal n that is nearest to z. The two are at right angles only if n_x = n_y.
double friction_of_frame(const Vec3& lean, double friction) {
  const Vec3 n = (Vec3::UnitZ() + lean).normalized(), downhill = (n.z() * n - Vec3::UnitZ()).normalized();
  const Vec3 first = Vec3(0, -n.z(), n.x()).normalized(), second = n.cross(first);
  const Eigen::Vector2d sliding(first.dot(downhill), second.dot(downhill)), impulse = -friction * sliding.normalized();
  const Vec3 force = n + impulse[0] * first + impulse[1] * second;
  return -force.dot(downhill) / force.dot(n);
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

BOOST_AUTO_TEST_CASE(friction_on_slopes_is_that_of_the_skewed_frame) {
  for (const Vec3& lean : {Vec3(0.45, 0, 0), Vec3(0.7, 0, 0), Vec3(0, 0.7, 0), Vec3(-0.4, 0.4, 0), Vec3(0.4, 0.4, 0)}) {
    for (const double friction : {0.1, 0.3}) {
      const double found = friction_on_slope(lean, friction), due = friction_of_frame(lean, friction);
      BOOST_TEST_MESSAGE(lean.transpose() << ", friction " << friction << ": " << found << " of " << due);
      // The solver ends within 1e-6 of the impulses, or the run would have a warning.
      BOOST_TEST(std::abs(found - due) < 1e-5 * friction);
    }
  }
  BOOST_TEST(friction_on_slope({0.45, 0, 0}, 0.3) < 0.95 * 0.3);  // short
  BOOST_TEST(friction_on_slope({0, 0.7, 0}, 0.5) > 1.1 * 0.5);    // too large
}

BOOST_AUTO_TEST_SUITE_END()
