#include "core/scene/scene.h"

#include <boost/test/unit_test.hpp>

#include "core/scene/features/features.h"
#include "tests/cases/truth/closed_form/contact/contact_scenes.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_scene_scene)

namespace {

bool inside(const Shape& shape, const Vec3& p) {
  if (const auto* s = std::get_if<Sphere>(&shape)) return p.norm() <= s->radius;
  if (const auto* b = std::get_if<Box>(&shape)) return (p.cwiseAbs().array() <= 0.5 * b->size.array()).all();
  const auto& c = std::get<Capsule>(shape);
  const Vec3 nearest(0, 0, std::clamp(p.z(), -0.5 * c.length, 0.5 * c.length));
  return (p - nearest).norm() <= c.radius;
}

Features features_of(const Scene& scene) {
  Features features;
  for (const Need& need : needs_of(scene)) features.insert(need.feature);
  return features;
}

}  // namespace

// A second derivation of each inertia: the sum over the cells of a lattice whose centres lie inside. With 120 cells per
// side a tenth of the cells are at the surface, and some are misassigned by chance: an error of a few in a thousand.
BOOST_AUTO_TEST_CASE(inertias_are_those_of_solid_bodies) {
  constexpr int kCells = 120;
  constexpr double kCell = 3.0 / kCells;  // m
  const auto centre = [](int k) { return (k + 0.5) * kCell - 1.5; };
  for (const Shape& shape : {Shape(Sphere{1.2}), Shape(Box{{0.5, 2, 1.1}}), Shape(Capsule{0.6, 1.5})}) {
    Mat3 sum = Mat3::Zero();
    int count = 0;
    for (int k = 0; k < kCells * kCells * kCells; ++k) {
      const Vec3 p(centre(k % kCells), centre(k / kCells % kCells), centre(k / kCells / kCells));
      if (!inside(shape, p)) continue;
      sum += p.squaredNorm() * Mat3::Identity() - p * p.transpose();
      ++count;
    }
    const Mat3 inertia = inertia_of(shape, 7);
    BOOST_TEST((7 * sum / count - inertia).norm() < 5e-3 * inertia.norm(), shape_name(shape));
  }
}

BOOST_AUTO_TEST_CASE(a_pair_s_law_does_not_depend_on_the_order_and_falls_back_on_the_default) {
  Scene scene;
  scene.contact_default = {0.1, 0.2};
  scene.contact_pairs = {{3, 5, {0.7, 0.8}}};
  BOOST_TEST(scene.contact_law(3, 5).restitution == 0.7);
  BOOST_TEST(scene.contact_law(5, 3).friction == 0.8);
  BOOST_TEST(scene.contact_law(3, 4).friction == 0.2);
}

BOOST_AUTO_TEST_CASE(pairs_that_never_touch_ask_for_a_filter_and_for_no_contact) {
  Scene scene;
  scene.bodies = {test::on_its_own("a", Sphere{1}, 1, Vec3::Zero()),
                  test::on_its_own("b", Box{{1, 1, 1}}, 1, Vec3::Zero()), test::plane()};
  scene.contact_pairs = {{0, 1, kApart}};
  const auto some = features_of(scene);
  BOOST_TEST((some.contains(Feature::contact_filter) && some.contains(contact_feature<Plane, Sphere>()) &&
              !some.contains(contact_feature<Box, Sphere>())));
  scene.contact_pairs = {{0, 1, kApart}, {0, 2, kApart}, {1, 2, kApart}};
  BOOST_TEST((features_of(scene) == Features{}));  // nothing touches, so nothing has to be filtered
}

BOOST_AUTO_TEST_CASE(a_scene_asks_for_what_it_uses_and_no_more) {
  BOOST_TEST((features_of(test::tumbling_body()) == Features{}));
  BOOST_TEST((features_of(test::fixed_spring()) == Features{Feature::spring}));
  BOOST_TEST((features_of(test::coupled_bodies(1)) == Features{Feature::spring, Feature::timed_force}));
  BOOST_TEST(
      (features_of(test::dropped_sphere(0)) == Features{contact_feature<Plane, Sphere>(), Feature::friction_infinite}));
  BOOST_TEST((features_of(test::dropped_sphere(1)) ==
              Features{contact_feature<Plane, Sphere>(), Feature::friction_infinite, Feature::restitution}));

  Scene scene = test::dropped_sphere(0);
  scene.bodies[0].collides = false;
  BOOST_TEST(features_of(scene).empty());

  scene = test::dropped_sphere(0);
  scene.contact_pairs = {{0, 1, {0.5, 0.3}}};  // the only pair: the default plays no part
  BOOST_TEST((features_of(scene) ==
              Features{contact_feature<Plane, Sphere>(), Feature::friction_coulomb, Feature::restitution}));
  scene.bodies.push_back(scene.bodies[0]);
  BOOST_TEST(
      (features_of(scene) == Features{contact_feature<Plane, Sphere>(), contact_feature<Sphere, Sphere>(),
                                      Feature::friction_coulomb, Feature::friction_infinite, Feature::restitution}));
  scene.joints = {{0, 1, HingeJoint{{0, 0, 0}, {0, 0, 1}}}};
  BOOST_TEST(features_of(scene).contains(joint_feature<HingeJoint>()));
}

BOOST_AUTO_TEST_SUITE_END()
