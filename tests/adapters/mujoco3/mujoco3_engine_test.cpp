// MuJoCo 3 against MuJoCo 2.2.2. Both get one text, so a smooth scene must move alike in both: an element that one of
// them misses moves it by far more than rounding.
#include "adapters/mujoco3/mujoco3_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "adapters/mujoco3/mujoco3_package.h"
#include "core/engine/engine_failure.h"
#include "tests/adapters/free_body_measures.h"
#include "tests/adapters/hung_rods.h"
#include "tests/core/dynamics/joints/jointed_run.h"
#include "tests/folder.h"
#include "tests/state_of.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_mujoco3_mujoco3_engine)

namespace {

double apart(const BodyTable& a, const BodyTable& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const BodyState one = a.columns().body(i), other = b.columns().body(i);
    most = std::max({most, (one.position - other.position).norm(), angle_between(one.orientation, other.orientation),
                     (one.velocity - other.velocity).norm(), (one.angular_velocity - other.angular_velocity).norm()});
  }
  return most;
}

constexpr double kStep = 1e-3;  // s
constexpr int kSteps = 200;

BodyTable after_steps(const std::string& run, const Scene& scene) {
  const auto world = load_run(run, scene);
  for (int n = 0; n < kSteps; ++n) world->step(kStep);
  return state_of(*world);
}

// The scene without one of the elements that were converted.
struct Told {
  const char* name;
  Scene scene;
  std::function<void(Scene&)> leave_out;
};

Scene hinged() { return hung_by({.a = 0, .b = 1, .type = HingeJoint{{1, 0.1, 0}, Vec3(0.2, 1, 0.3).normalized()}}); }

Scene with_motor(const Motor& motor) {
  Scene scene = hinged();
  scene.motors = {motor};
  return scene;
}

Scene with(Scene scene, const std::function<void(Joint&)>& change) {
  change(scene.joints[1]);
  return scene;
}

std::vector<Told> told() {
  const auto last = [](const std::function<void(Joint&)>& change) {
    return [change](Scene& scene) { change(scene.joints[1]); };
  };
  Motor push{.joint = 1, .speed = {}}, friction{.joint = 1, .speed = 0};
  push.effort = 3, push.from = 0.05, push.until = 0.15;
  friction.most = 0.4, friction.is_friction = true;
  Scene gears = test::suite_scene("transmissions/gear-pair"), loop = test::suite_scene("mechanisms/four-bar");
  return {{"a spring", with(hinged(), [](Joint& joint) { joint.stiffness = 30, joint.rest = 0.4; }),
           last([](Joint& joint) { joint.stiffness = 0; })},
          {"a damper", with(hinged(), [](Joint& joint) { joint.damping = 2; }),
           last([](Joint& joint) { joint.damping = 0; })},
          {"an armature", with(hinged(), [](Joint& joint) { joint.armature = 0.3; }),
           last([](Joint& joint) { joint.armature = 0; })},
          {"a limit", with(hinged(), [](Joint& joint) { joint.lower = -0.05, joint.upper = 0.05; }),
           last([](Joint& joint) { joint.lower = -1e9, joint.upper = 1e9; })},
          {"an effort", with_motor(push), [](Scene& scene) { scene.motors.clear(); }},
          {"friction", with_motor(friction), [](Scene& scene) { scene.motors.clear(); }},
          {"a coupling", gears, [](Scene& scene) { scene.couplings.clear(); }},
          {"a loop", loop, [](Scene& scene) { scene.joints.pop_back(); }}};
}

}  // namespace

// The same formulas in other roundings: a few of them at each step, which the motion makes larger. Two differences are
// no roundings. An effort is a couple from Rigor, which does not turn within a step of rk4: at 2 rad/s its share along
// the axis changes by 2e-6. MuJoCo 3 adds the term J' v to the acceleration that closes a loop.
BOOST_AUTO_TEST_CASE(it_moves_as_mujoco_2_and_no_element_is_left_out) {
  for (const Told& one : told()) {
    for (const char* method : {"euler", "implicit", "rk4"}) {
      const BodyTable due = after_steps(fmt::format("mujoco:{}", method), one.scene),
                      found = after_steps(fmt::format("mujoco3:{}", method), one.scene);
      Scene without = one.scene;
      one.leave_out(without);
      const double difference = apart(found, due),
                   effect = apart(after_steps(fmt::format("mujoco3:{}", method), without), due);
      BOOST_TEST_MESSAGE(one.name << ", " << method << ": " << difference << ", without it " << effect);
      const bool is_couple = std::string(one.name) == "an effort" && std::string(method) == "rk4";
      const double within = one.name == std::string("a loop") ? 1e-4 : is_couple ? 1e-6 : 1e-9;
      BOOST_TEST(difference < within, one.name << ", " << method << ": " << difference);
      BOOST_TEST(effect > 1e-4, one.name << ", " << method << ": " << effect);
    }
  }
}

BOOST_AUTO_TEST_CASE(joints_of_each_kind_and_cases_of_the_suite_move_as_in_mujoco_2) {
  std::vector<std::pair<std::string, Scene>> scenes;
  for (Joint joint : joints_of_each_kind()) {
    joint.a = 0, joint.b = 1;
    scenes.emplace_back(joint_type_name(joint), hung_by(joint));
    std::swap(joint.a, joint.b);
    scenes.emplace_back(joint_type_name(joint) + ", ends exchanged", hung_by(joint));
  }
  for (const char* id :
       {"joints/compound-root", "joints/planar-slide", "drives/friction-slider", "drives/sampled-pd",
        "drives/servo-saturated", "drives/torque-in-time", "springs/body-springs", "transmissions/geared-arm",
        "transmissions/armature-on-moving-base", "transmissions/rack-and-pinion", "transmissions/screw-under-gravity",
        "mechanisms/ragdoll", "forces/switches-inside-steps"})
    scenes.emplace_back(id, test::suite_scene(id));
  for (const auto& [name, scene] : scenes) {
    const double difference = apart(after_steps("mujoco3", scene), after_steps("mujoco", scene));
    BOOST_TEST_MESSAGE(name << ": " << difference);
    BOOST_TEST(difference < 1e-9, name << ": " << difference);
  }
}

BOOST_AUTO_TEST_CASE(contacts_are_those_of_mujoco_2) {
  for (const char* track : {"", "@stock"}) {
    for (const char* id : {"contact/sliding-stop", "contact/slope-holds", "rolling-friction/ball-rolls-to-rest",
                           "contact/toppling-cylinder"}) {
      const Scene scene = test::suite_scene(id);
      const double difference = apart(after_steps(fmt::format("mujoco3{}", track), scene),
                                      after_steps(fmt::format("mujoco{}", track), scene));
      BOOST_TEST_MESSAGE(id << track << ": " << difference);
      BOOST_TEST(difference < 1e-6, id << track << ": " << difference);
    }
  }
}

// A pair's margin is the sum of both geoms' in MuJoCo 3, and the larger one in MuJoCo 2.
BOOST_AUTO_TEST_CASE(a_margin_holds_bodies_as_far_apart_as_in_mujoco_2) {
  Scene scene = sliding_box(0, 0, 0);
  const auto height = [&](const std::string& run) {
    return body_after(*load_run(run, scene), kStep, 1000).position.z();
  };
  const double rests = height("mujoco3");
  BOOST_TEST(std::abs(height("mujoco3,contact-margin=0.01") - rests - 0.01) < 1e-4);
  BOOST_TEST(std::abs(height("mujoco3,contact-margin=0.01") - height("mujoco,contact-margin=0.01")) < 1e-6);
  const auto in_force = load_run("mujoco3,contact-margin=0.01", scene)->settings_in_force();
  BOOST_TEST(setting(in_force, "contact margin") == "0.01 m: bodies rest that far apart");
}

BOOST_AUTO_TEST_CASE(what_mujoco_2_refuses_is_refused_in_the_same_words) {
  Scene loop = hung_by({.a = 0, .b = 1, .type = HingeJoint{{1, 0.1, 0}, Vec3::UnitY()}});
  loop.joints.push_back({.a = kWorld, .b = 1, .type = HingeJoint{{2, 0.3, 0.2}, Vec3::UnitY()}, .damping = 0.1});
  loop.joints[0] = {.a = kWorld, .b = 0, .type = HingeJoint{{0, 0, 0}, Vec3::UnitY()}, .damping = 0.1};
  loop.joints[1].damping = 0.1;
  Scene rolling = sliding_box(1, 0, 0.5);
  rolling.contact_default.rolling_friction = 0.01;
  for (const Scene& scene : {loop, rolling}) {
    std::vector<std::string> said;
    for (const char* engine : {"mujoco", "mujoco3"}) {
      try {
        load_run(engine, scene);
        said.emplace_back("nothing");
      } catch (const EngineFailure& failure) {
        BOOST_TEST((failure.kind() == FailureKind::unsupported));
        said.emplace_back(failure.what());
      }
    }
    BOOST_TEST(said[0] == said[1]);
    BOOST_TEST(said[0] != "nothing");
  }
  const EngineInfo &two = engines().info_of("mujoco"), &three = engines().info_of("mujoco3");
  BOOST_TEST((two.features == three.features));
}

BOOST_AUTO_TEST_CASE(a_world_that_mujoco_sets_back_to_its_start_is_lost) {
  const auto world = load_run("mujoco3", asymmetric_top());
  const BodyState end = body_after(*world, 1.0 / 30, 1800);
  BOOST_TEST(!(end.position.allFinite() && std::isfinite(end.angular_velocity.norm())));
  BOOST_TEST(world->solver_warning().find("back to its start") != std::string::npos, world->solver_warning());
}

// -76.4 % and -3e-6 in MuJoCo 2.2.2; `implicitfast` has no part of the gyroscopic torque's derivative.
BOOST_AUTO_TEST_CASE(the_methods_are_what_their_names_say) {
  BOOST_TEST(std::abs(energy_gained_by_top("mujoco3:implicit") + 0.764) < 1e-3);
  BOOST_TEST(std::abs(energy_gained_by_top("mujoco3:rk4") + 3e-6) < 1e-6);
  BOOST_TEST(energy_gained_by_top("mujoco3:implicitfast") != energy_gained_by_top("mujoco3:implicit"));
}

BOOST_AUTO_TEST_CASE(settings_are_read_back) {
  const Scene scene = sliding_box(1, 0, 0.5);
  const auto matched = load_run("mujoco3,iterations=77", scene)->settings_in_force();
  BOOST_TEST(setting(matched, "friction cone") == "elliptic");
  BOOST_TEST(setting(matched, "solver") == "Newton, at most 77 iterations to 0");
  BOOST_TEST(setting(matched, "contacts") == "solref 0.02 1, solimp 0.999 0.999 0.001");
  const auto stock = load_run("mujoco3@stock", scene)->settings_in_force();
  BOOST_TEST(setting(stock, "friction cone") == "pyramidal");
  BOOST_TEST(setting(stock, "contacts") == "solref 0.02 1, solimp 0.9 0.95 0.001");
}

// The folder of RIGOR_MUJOCO3 is looked at first; one without the package does not count.
BOOST_AUTO_TEST_CASE(the_package_is_found_where_it_is_named_or_beside_the_program) {
  const Folder folder;
  const std::string before = mujoco3_package_folder();
  BOOST_TEST(!before.empty());
  BOOST_TEST(engines().info_of("mujoco3").version == mujoco3_version(before));
  setenv("RIGOR_MUJOCO3", folder.path.c_str(), 1);
  BOOST_TEST(mujoco3_package_folder() == before);
  folder.write("node_modules/@mujoco/mujoco/package.json", R"({"version": "3.99.0"})");
  BOOST_TEST(mujoco3_package_folder() == folder.path.string());
  BOOST_TEST(mujoco3_version(mujoco3_package_folder()) == "3.99.0");
  unsetenv("RIGOR_MUJOCO3");
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder.path.c_str(), 1);  // no Node
  BOOST_TEST(mujoco3_package_folder().empty());
  setenv("PATH", path.c_str(), 1);
}

BOOST_AUTO_TEST_SUITE_END()
