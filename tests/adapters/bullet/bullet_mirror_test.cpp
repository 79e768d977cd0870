// Scenes where Bullet's result changes when they are mirrored, x to -x, which is exact in doubles. Limits of joints do
// not change it (bullet_joints_test.cpp). Contact points of a box that touches with several corners at once do: Bullet
// searches for them by turns in one fixed sense, and treats them one after another.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "cases/case/suite.h"
#include "cases/runner/simulate.h"
#include "cases/truth/solved/events/equivalent_scene.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_bullet_bullet_mirror)

namespace {

// m, the largest distance between the scene's motion and the mirror image of the mirrored scene's.
double asymmetry(const std::string& id, const std::string& name, double dt, double duration) {
  const Scene scene = select_cases({id}, default_suite_dir(), test::words()).at(0).scene;
  const RunName run = parse_run_name(name, infos_of(engines()));
  const auto moved = [&](const Scene& one) {
    return simulate(find_engine(engines(), run.engine), run.settings, one, dt, duration).trajectory;
  };
  Equivalence mirrored;
  mirrored.is_mirrored = true;
  const Trajectory as_is = moved(scene), image = moved(equivalent(scene, mirrored));
  double most = 0;
  for (std::size_t n = 0; n < as_is.samples.size(); ++n) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      Vec3 back = image.samples[n].bodies.columns().position(i);
      back.x() = -back.x();
      most = std::max(most, (as_is.samples[n].bodies.columns().position(i) - back).norm());
    }
  }
  return most;
}

}  // namespace

// One corner, one edge's end, or a capsule's round end: no two points touch in the same instant.
BOOST_AUTO_TEST_CASE(without_a_tie_contacts_are_mirrored_to_the_last_bit) {
  for (const char* name : {"bullet", "bullet@stock"}) {
    for (const double dt : {1.0 / 30, 1.0 / 240, 1.0 / 1000}) {
      for (const char* id : {"contact/tumbling-box", "contact/dropped-capsule", "contact/bounce-half"})
        BOOST_TEST(asymmetry(id, name, dt, 0.9) == 0, id << ", " << name << " at " << dt << " s");
    }
  }
}

// Two corners of an edge touch at once. Measured 5.2e-5 m within 0.9 s at 1/1000 s, from the first step on; a tenth of
// that still tells it from rounding.
BOOST_AUTO_TEST_CASE(corners_that_touch_at_once_are_treated_in_an_order_that_a_mirror_changes) {
  BOOST_TEST(asymmetry("contact/toppling-box", "bullet", 1.0 / 1000, 0.9) > 5e-6);
  BOOST_TEST(asymmetry("contact/toppling-box", "bullet", 1.0 / 1000, 0.9) < 1e-3);
}

BOOST_AUTO_TEST_SUITE_END()
