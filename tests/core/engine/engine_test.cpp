#include "core/engine/engine.h"

#include <boost/test/unit_test.hpp>

#include <utility>

#include "core/engine/clock.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_engine_engine)

BOOST_AUTO_TEST_CASE(equal_steps_add_up_without_rounding) {
  Clock clock;
  for (int n = 0; n < 9000; ++n) clock.advance(1.0 / 30);
  BOOST_TEST(clock.time() == 9000 * (1.0 / 30));
  clock.advance(0.5);
  BOOST_TEST(clock.time() == 9000 * (1.0 / 30) + 0.5);
}

BOOST_AUTO_TEST_CASE(a_table_gives_back_what_was_put_in) {
  for (const std::size_t size : {1, 7, 8, 9, 100}) {
    BodyTable table(size, true);
    for (std::size_t i = 0; i < size; ++i) {
      const double x = static_cast<double>(i);
      table.columns().set_body(i, {{x, 1, 2}, Quat(1, x, 3, 4), {5, x, 6}, {7, 8, x}});
      table.columns().set_rotation(i, Mat3::Constant(x));
    }
    const BodyTable copy(std::as_const(table).columns());
    for (std::size_t i = 0; i < size; ++i) {
      const double x = static_cast<double>(i);
      const BodyState state = copy.columns().body(i);
      BOOST_TEST((state.position == Vec3(x, 1, 2) && state.velocity == Vec3(5, x, 6)));
      BOOST_TEST((state.orientation.coeffs() == Quat(1, x, 3, 4).coeffs() && state.angular_velocity == Vec3(7, 8, x)));
      BOOST_TEST((copy.columns().rotation(i) == Mat3::Constant(x)));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_borrowed_snapshot_shows_the_owner_and_an_owned_one_does_not) {
  BodyTable world(1);
  Snapshot lent, filled;
  lent.borrow(std::as_const(world).columns());
  filled.own(1).set_position(0, {1, 1, 1});
  world.columns().set_position(0, {4, 5, 6});
  BOOST_TEST((lent.bodies().position(0) == Vec3(4, 5, 6)));
  BOOST_TEST((filled.bodies().position(0) == Vec3(1, 1, 1)));
  filled.borrow(std::as_const(world).columns());
  BOOST_TEST((filled.bodies().position(0) == Vec3(4, 5, 6)));
  filled.own(1).set_position(0, {2, 2, 2});
  BOOST_TEST((filled.bodies().position(0) == Vec3(2, 2, 2)));
}

BOOST_AUTO_TEST_CASE(what_an_engine_lacks_is_said_with_what_asks_for_it) {
  EngineInfo engine{.name = "plain", .version = "1", .precision = "double"};
  Scene scene = test::fixed_spring();
  BOOST_TEST(why_unsupported(engine, scene, 0.1) ==
             "plain has no spring, which a spring between 'world' and 'cube' asks for");
  engine.features = {Feature::spring};
  BOOST_TEST(why_unsupported(engine, scene, 0.1) == "");
  scene.bodies[0].angular_velocity = {0, 30, 0};
  engine.max_rotation_per_step = 1;
  BOOST_TEST(why_unsupported(engine, scene, 1.0 / 31) == "");
  BOOST_TEST(why_unsupported(engine, scene, 0.1) ==
             "plain turns a body by at most 1 rad in one step; 'cube' turns by 3 rad");
}

BOOST_AUTO_TEST_CASE(a_choice_that_cannot_express_the_scene_is_refused_with_one_that_can) {
  EngineInfo engine{.name = "plain", .version = "1", .precision = "double"};
  engine.features = {contact_feature<Plane, Sphere>(), Feature::friction_infinite, Feature::friction_coulomb,
                     Feature::restitution};
  OptionInfo contact{.name = "contact", .meaning = "how", .choices = {"rough", "true"}};
  contact.features_of_choice["rough"] = {contact_feature<Plane, Sphere>(), Feature::friction_infinite,
                                         Feature::restitution};
  contact.features_of_choice["true"] = engine.features;
  engine.methods = {{.name = "euler", .summary = "first order", .options = {contact}}};
  Scene scene = test::dropped_sphere(0.5);
  const auto why = [&](const std::map<std::string, std::string>& options) {
    return why_unsupported(engine, {"euler", options}, scene, 0.1);
  };
  BOOST_TEST(why({}) == "");
  BOOST_TEST(why({{"contact", "rough"}}) == "");
  scene.contact_default.friction = 0.5;
  BOOST_TEST(why({}) == "");
  BOOST_TEST(why({{"contact", "true"}}) == "");
  BOOST_TEST(why({{"contact", "rough"}}) ==
             "plain with contact=rough has no friction:coulomb, which bodies 'ground' and 'ball' may touch asks for; "
             "contact=true would do");
  scene.contact_default.friction = 0;
  BOOST_TEST(why({{"contact", "true"}}) ==
             "plain has no friction:none, which bodies 'ground' and 'ball' may touch asks for");
}

BOOST_AUTO_TEST_SUITE_END()
