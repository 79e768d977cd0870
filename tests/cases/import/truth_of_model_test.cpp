#include <boost/test/unit_test.hpp>

#include "cases/import/import.h"
#include "cases/truth/truth.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_import_truth_of_model)

// 'reference' solves scenes without contacts.
BOOST_AUTO_TEST_CASE(a_model_gets_a_truth_that_takes_it) {
  Scene scene;
  scene.bodies = {test::body("cart", 1, {1, 1, 1})};
  scene.joints = {{kWorld, 0, SliderJoint{Vec3::UnitX()}}};
  BOOST_TEST(truth_of_model(scene) == "reference");
  const std::vector<SeriesAxis> axes = {{false, Vec3::Zero(), Vec3::UnitX()}, {false, Vec3::Zero(), Vec3::UnitZ()}};
  scene.joints = {
      {kWorld, 0, CompoundJoint{axes}}, {kWorld, 0, CompoundAxis{axes, 0}}, {kWorld, 0, CompoundAxis{axes, 1}}};
  BOOST_TEST(truth_of_model(scene) == "reference");
  BOOST_CHECK_NO_THROW(make_truth("reference", scene, 0.1));
  Body ground = test::body("ground", 1, {1, 1, 1});
  ground.fixed = true;
  ground.shape = Plane{Vec3::UnitZ(), 0}, scene.bodies[0].shape = Sphere{0.1};
  ground.collides = scene.bodies[0].collides = true;
  scene.bodies.push_back(ground);
  BOOST_TEST(truth_of_model(scene) == "none");
}

BOOST_AUTO_TEST_SUITE_END()
