// Truths over surfaces: a plane in place of a flat part, up to its border.
#include "cases/truth/flat_ground.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tests/cases/truth/closed_form/contact/contact_scenes.h"
#include "tests/core/scene/toml/refusal.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_flat_ground)

namespace {

// A ball of 0.1 m at `at`, thrown along x at 1 m/s, over a slab of 4 by 4 by 0.2 m whose top is z = 0.
Scene ball_over_slab(const Vec3& at) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.bodies = {
      test::on_its_own("ball", Sphere{0.1}, 1, at),
      test::on_its_own("slab", Mesh{{closed_surface(scaled(unit_cube(), Vec3(4, 4, 0.2)))}}, 1, {0, 0, -0.1})};
  scene.bodies[0].velocity = {1, 0, 0}, scene.bodies[1].fixed = true;
  scene.contact_default = {0.5, 0};
  return scene;
}

std::string refusal_of_start(const Vec3& at) {
  return refusal_of([&] { make_truth("bounce", ball_over_slab(at), 1); });
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_ball_bounces_on_the_top_of_a_slab_as_on_a_plane) {
  const Scene scene = ball_over_slab({-1, 0, 0.6});
  Scene plane = scene;
  plane.bodies[1].shape = Plane{Vec3::UnitZ(), 0}, plane.bodies[1].position = Vec3::Zero();
  const auto on_slab = make_truth("bounce", scene, 2), on_plane = make_truth("bounce", plane, 2);
  BodyTable found(2), expected(2);
  for (const double t : {0.0, 0.3, 0.7, 1.9}) {
    on_slab->at(t, found.columns()), on_plane->at(t, expected.columns());
    BOOST_TEST((found.columns().position(0) - expected.columns().position(0)).norm() < 1e-14);
    BOOST_TEST((found.columns().position(1) == Vec3(0, 0, -0.1)));  // the slab stays where it is
    BOOST_TEST(on_slab->error(t) == on_plane->error(t));
  }
  BOOST_TEST(on_slab->caveat() == on_plane->caveat());
}

// It starts 1 m from the border, and its radius is 0.1 m: after 0.9 s the slab is no plane for it.
BOOST_AUTO_TEST_CASE(it_ends_where_a_body_comes_to_the_border) {
  const auto truth = make_truth("bounce", ball_over_slab({1, 0, 0.6}), 2);
  BOOST_TEST(std::isfinite(truth->error(0.898)));
  BOOST_TEST(std::isinf(truth->error(0.9)));
  BOOST_TEST(truth->caveat().find("'ball' is at the border of the flat part of 'slab'") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_body_that_starts_beside_or_behind_the_flat_part_is_refused) {
  BOOST_TEST(refusal_of_start({3, 0, 0.6}).find("at the border") != std::string::npos);
  BOOST_TEST(refusal_of_start({0, 0, -0.6}) != "");
}

// Waves have no part in front of all others: the truth says what it is for.
BOOST_AUTO_TEST_CASE(ground_that_is_not_flat_has_no_such_truth) {
  Scene scene = ball_over_slab({0, 0, 0.9});
  Heightfield waves;
  waves.size = {4, 4}, waves.heights = {{0, 0.1, 0}, {0.1, 0, 0.2}, {0, 0.3, 0.05}};
  waves.surface = height_surface(waves.size, waves.heights);
  scene.bodies[1].shape = waves;
  BOOST_TEST(refusal_of([&] { make_truth("bounce", scene, 1); }) != "");
}

BOOST_AUTO_TEST_SUITE_END()
