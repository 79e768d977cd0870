#include <boost/test/unit_test.hpp>

#include "core/base/error.h"
#include "tests/cases/truth/closed_form/smooth/smooth_scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_closed_form_smooth_oscillator)

namespace {

// Whether the truth of a run this long is refused because the body gets to the spring's other end.
bool passes_the_end(double speed, double damping, double duration) {
  Scene scene = test::oscillator(damping);
  scene.bodies[0].velocity = {speed, 0, 0};
  try {
    make_truth("oscillator", scene, duration);
  } catch (const InputError& error) {
    BOOST_TEST(std::string(error.what()).find("other end") != std::string::npos, error.what());
    return true;
  }
  return false;
}

}  // namespace

// 1.25 m from the end where it rests; 5 rad/s, a period of 1.2566 s; it starts .25 m outside.
BOOST_AUTO_TEST_CASE(it_is_refused_from_the_instant_on_at_which_it_reaches_the_springs_other_end) {
  constexpr double kPeriod = 1.2566370614359173;
  // 8 m/s swing 1.62 m: outwards first, through the rest at .53 s, at the end 1.25 m inside .18 s after that.
  BOOST_TEST(!passes_the_end(8, 0, 0.5 * kPeriod));
  BOOST_TEST(passes_the_end(8, 0, 0.75 * kPeriod));
  BOOST_TEST(passes_the_end(8, 0, kPeriod));  // out and back: neither its start nor its end is near
  BOOST_TEST(passes_the_end(-8, 0, kPeriod));
  // 6 m/s swing 1.226 m, which is not as far, either way.
  BOOST_TEST(!passes_the_end(6, 0, 3 * kPeriod));
  BOOST_TEST(!passes_the_end(-6, 0, 3 * kPeriod));
  // Damped, it gets there if it goes there at once and not after the way out.
  BOOST_TEST(passes_the_end(-9, 4, kPeriod));
  BOOST_TEST(!passes_the_end(9, 4, 3 * kPeriod));
}

BOOST_AUTO_TEST_SUITE_END()
