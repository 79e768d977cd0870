// That a mechanism which passes a singular position says so, when, and that no other does.
#include "core/dynamics/joints/singular_passages.h"

#include <boost/test/unit_test.hpp>

#include "tests/core/dynamics/joints/jointed_run.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_joints_singular_passages)

namespace {

// As a run of core:rk4 says it at its end; empty if it says nothing.
std::string said_by(const std::string& scene, double dt, double end) {
  const Scene s = test::suite_scene(scene);
  const auto world = CoreEngine().load(s, {.method = "rk4", .options = {}});
  test::step_until(*world, dt, end);
  for (const auto& [key, value] : world->settings_in_force()) {
    if (key == "singular positions") return value;
  }
  return "";
}

// When the crank of slider-crank-singular is upright: where its centre's x, which starts above zero, comes to zero.
double upright_at(double dt) {
  const auto world =
      CoreEngine().load(test::suite_scene("mechanisms/slider-crank-singular"), {.method = "rk4", .options = {}});
  Snapshot now;
  double t = 0, x = 1;
  while (true) {
    world->step(dt), world->read(now);
    const double next = now.bodies().position(0).x();
    if (next <= 0) return t + dt * x / (x - next);
    t += dt, x = next;
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_pivot_that_comes_down_to_zero_is_a_passage_and_one_that_does_not_is_none) {
  // d², passed between two instants; and the same raised by the square of a hundredth of a radian.
  for (const double raised : {0.0, 1e-4}) {
    SingularPassages passages;
    for (int n = 0; n <= 100; ++n) {
      const double t = 0.01 * n, d = t - 0.5037;
      passages.note(t, d * d + raised);
    }
    if (raised == 0) {
      BOOST_TEST_REQUIRE(passages.times().size() == 1u);
      BOOST_TEST(passages.times()[0] == 0.5037, boost::test_tools::tolerance(1e-9));
      BOOST_TEST(passages.text() == "at 0.5037 s");
    } else {
      BOOST_TEST(passages.times().empty());
    }
  }
  SingularPassages level;  // a mechanism that does not change, but for roundings
  for (int n = 0; n < 100; ++n) level.note(n, 1e-3 + 1e-18 * (n % 3));
  BOOST_TEST(level.text() == "");
}

BOOST_AUTO_TEST_CASE(many_passages_are_counted_and_the_first_are_named) {
  SingularPassages passages;
  for (int n = 0; n < 2000; ++n) passages.note(0.01 * n, std::pow(std::sin(0.01 * n - 0.303), 2));
  BOOST_TEST(passages.times().size() == 5u);
  BOOST_TEST(passages.text().ends_with("and 2 more"), passages.text());  // 0.303 + n pi before 20 s: seven
}

BOOST_AUTO_TEST_CASE(a_slider_crank_of_equal_lengths_is_named_when_it_is_upright) {
  for (const double dt : {1.0 / 240, 1.0 / 1000}) {
    const double upright = upright_at(dt);
    const std::string said = said_by("mechanisms/slider-crank-singular", dt, 0.5);
    BOOST_TEST_CONTEXT(said << ", upright at " << upright << " s") {
      BOOST_TEST_REQUIRE(said.starts_with("at "));
      // Four digits are printed; the line between two steps is off by the square of a step's turn.
      BOOST_TEST(std::abs(std::stod(said.substr(3)) - upright) < 1e-3);
    }
  }
}

BOOST_AUTO_TEST_CASE(cranks_that_fold_flat_are_named_and_regular_mechanisms_are_not) {
  BOOST_TEST(said_by("mechanisms/iftomm-a02-2", 1.0 / 240, 2) != "");
  for (const char* regular : {"mechanisms/four-bar", "mechanisms/slider-crank", "mechanisms/trammel",
                              "mechanisms/iftomm-a04", "joints/double-pendulum", "joints/mass-ratio-chain"})
    BOOST_TEST(said_by(regular, 1.0 / 1000, 2) == "", regular);
}

// The four-bar linkages of A02 fold flat half a turn after another: there no inner step is short enough for the
// tolerance.
BOOST_AUTO_TEST_CASE(an_adaptive_method_names_the_position_that_it_cannot_pass) {
  const auto world =
      CoreEngine().load(test::suite_scene("mechanisms/iftomm-a02-2"), {.method = "dormand-prince", .options = {}});
  Snapshot now;
  while (world->solver_warning().empty()) {
    world->step(0.01), world->read(now);
    BOOST_TEST_REQUIRE(now.time < 1);
  }
  BOOST_TEST(now.time == 0.72, boost::test_tools::tolerance(1e-9));  // the first level position is at 0.7144 s
  BOOST_TEST(world->solver_warning().starts_with("in a singular position of the joints, or beside it, the tolerance"));
}

// Its Jacobian never loses rank, however small a pivot gets beside its row.
BOOST_AUTO_TEST_CASE(an_open_chain_passes_no_singular_position) {
  BOOST_TEST(said_by("joints/double-pendulum-chaotic", 1.0 / 240, 10) == "");
  BOOST_TEST(said_by("joints/chain-10", 1.0 / 240, 3) == "");
}

BOOST_AUTO_TEST_SUITE_END()
