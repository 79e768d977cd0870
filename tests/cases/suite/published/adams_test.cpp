// Mechanisms that MSC ADAMS computed. Each case's truth, and the best method of the core, meet ADAMS's figures within
// the rounding of their last digit and ADAMS's own error. The figures, and what they mean, stand in adams_figures.csv.
//
// ADAMS's own error is not published. Its tables show it:
//
//   - Three tables are one motion, of a rod released level. revolute-1 and cylindrical-2 agree with the closed form to
//     every digit of the positions. spherical-1 is 8.4e-4 m away from them.
//   - No joint does work, but the energy of the states in its tables drifts: by 7.9e-3 J in spherical-1, universal-1
//     and universal-2, as of 8.1e-4 m of height; by 3.3e-4 J in distance-2; by 7.5e-5 J in revolute-1.
//   - The force in prismatic-2 is constant. ADAMS's wavers by 8e-4 N, and its couple by that at 2 x 61 m.
// The truth has two solutions that agree to 1e-9. So the limits in the table below are ADAMS's errors: what its whole
// tables miss, measured, and a tenth more.
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "cases/metrics/measures/joints/joint_reactions.h"
#include "cases/truth/truth.h"
#include "core/dynamics/model/system.h"
#include "generated/tests/places.h"
#include "tests/cases/judged.h"
#include "tests/cases/suite/published/adams_tables.h"
#include "tests/core/dynamics/joints/jointed_run.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_suite_published_adams)

namespace {

using test::AdamsCase, test::AdamsFigures, test::AdamsError;

constexpr double kDuration = 5;  // s, of all tables

const std::vector<AdamsCase>& all_cases() {
  static const std::vector<AdamsCase> cases = {
      {"adams-actuator-1", "lin_actuator/LinActuator_Case01", "P", 6, {}},
      {"adams-actuator-2", "lin_actuator/LinActuator_Case02", "P", 6, {}},
      {"adams-cylindrical-1", "cylindrical_joint/Cylindrical_Case01", "", 6, {}},
      {"adams-cylindrical-2", "cylindrical_joint/Cylindrical_Case02", "", 6, {1.1e-8, 0, 6.7e-4, 0}},
      {"adams-distance-1", "distance_constraint/Distance_Case01", "", 7, {1.4e-8, 0, 1.5e-3, 0}},
      {"adams-distance-2", "distance_constraint/Distance_Case02", "", 7, {1.9e-5, 2.8e-5, 0.019, 0}, {1, 2, 3}},
      {"adams-prismatic-1", "prismatic_joint/Prismatic_Case01", "", 6, {}},
      {"adams-prismatic-2", "prismatic_joint/Prismatic_Case02", "", 6, {0, 0, 8.5e-4, 0.103}, {1, 2, 3}},
      {"adams-revolute-1", "revolute_joint/Revolute_Case01", "", 6, {1.1e-8, 0, 6.4e-4, 0}},
      {"adams-revolute-spherical-1",
       "revsph_constraint/RevSpherical_Case01",
       "_Body1",
       6,
       {4.1e-7, 1.9e-7, 3.7e-3, 6.3e-3}},
      {"adams-rotational-spring-1", "rotspring_force/RotSpring_Case01", "", 7, {1.5e-6, 5.1e-7, 8.5e-4, 1.6e-4}},
      {"adams-rotational-spring-2", "rotspring_force/RotSpring_Case02", "", 7, {7.0e-7, 3.0e-7, 2.8e-3, 2.7e-5}},
      {"adams-spherical-1", "spherical_joint/Spherical_Case01", "", 6, {9.3e-4, 5.0e-4, 0.0141, 0}},
      {"adams-spring-1", "transpring_force/TranSpring_Case01", "", 6, {}},
      {"adams-spring-2", "transpring_force/TranSpring_Case02", "", 7, {7.4e-9, 0, 7.7e-8, 0}},
      {"adams-spring-3", "transpringcb_force/TranSpringCB_Case03", "", 7, {1.6e-7, 1.4e-5, 4.6e-6, 0}, {1, 2, 3}},
      {"adams-spring-4", "transpringcb_force/TranSpringCB_Case04", "", 7, {3.0e-5, 1.8e-5, 8.2e-4, 0}},
      {"adams-universal-1", "universal_joint/Universal_Case01", "", 6, {9.3e-4, 5.0e-4, 0.0141, 0}},
      {"adams-universal-2", "universal_joint/Universal_Case02", "", 6, {9.3e-4, 5.0e-4, 0.0141, 0}},
  };
  return cases;
}

const std::map<std::string, test::AdamsTable>& cited() {
  static const auto tables =
      test::cited_adams_figures(RIGOR_SOURCE_DIR "/tests/cases/suite/published/adams_figures.csv");
  return tables;
}

std::string path_of(const AdamsCase& one) { return "published/" + one.id; }

// The force with which the one body of a scene pushes the ground: all loads on it but gravity, the other way round. An
// actuator's effort is none of them. It follows from the motion, which has no acceleration.
class GroundLoads {
 public:
  GroundLoads(const Scene& scene, const Vec3& marker)
      : scene_(without_motors(scene)), system_(scene_), marker_(marker), is_driven_(!scene.motors.empty()) {
    if (scene_.joints.empty()) return;
    BOOST_TEST_REQUIRE(why_reactions_are_unknown(scene_) == "");
    reactions_ = std::make_unique<JointReactions>(scene_);
  }

  AdamsFigures at(BodyColumns bodies, double t) {
    const BodyState body = bodies.body(0);
    AdamsFigures found{t, body.position, body.orientation, Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), is_driven_};
    const Vec3 weight = scene_.bodies[0].mass * scene_.gravity;
    const auto push_ground = [&](const Vec3& force, const Vec3& couple, const Vec3& point) {
      found.force -= force, found.couple -= couple + (point - marker_).cross(force);
    };
    Wrenches wrenches;
    system_.wrenches(bodies, t, 0, wrenches);
    push_ground(wrenches[0].force - weight, wrenches[0].torque, body.position);
    if (reactions_) {
      const auto carried = reactions_->at(bodies, t);
      BOOST_TEST_REQUIRE(carried.has_value());
      for (std::size_t k = 0; k < carried->size(); ++k) {
        const Vec3 point = end_motion(JointGeometry(scene_, scene_.joints[k]).b(), bodies).point();
        push_ground((*carried)[k].force, (*carried)[k].couple, point);
      }
    }
    if (is_driven_) {
      BOOST_TEST((body.velocity - scene_.bodies[0].velocity).norm() < 1e-13);  // roundings of 1 m/s
      found.drive = found.force - weight;
    }
    return found;
  }

 private:
  static Scene without_motors(Scene scene) {
    scene.motors.clear();
    return scene;
  }

  Scene scene_;
  System system_;
  Vec3 marker_;
  bool is_driven_;
  std::unique_ptr<JointReactions> reactions_;
};

// Beyond the rounding of the table's digits.
AdamsError beyond_rounding(const AdamsFigures& found, const AdamsFigures& printed, int digits) {
  const auto of = [&](const Vec3& a, const Vec3& b) { return test::beyond_rounding(a, b, digits); };
  // Four components, each below 1, turn a unit quaternion by at most twice the norm of their roundings.
  const double turn = 4 * test::half_digit(0.5, digits);
  AdamsError error{of(found.position, printed.position), angle_between(found.orientation, printed.orientation) - turn,
                   of(found.force, printed.force), of(found.couple, printed.couple)};
  if (printed.has_drive) error.force = std::max(error.force, of(found.drive, printed.drive));
  return error;
}

void keep_largest(AdamsError& largest, const AdamsError& one) {
  for (const auto part : {&AdamsError::position, &AdamsError::rotation, &AdamsError::force, &AdamsError::couple})
    largest.*part = std::max(largest.*part, one.*part);
}

// Zeros of ADAMS are up to 4.2e-12 N m.
constexpr double kRounding = 1e-11;

bool is_within(const AdamsError& found, const AdamsError& allowed) {
  return found.position <= allowed.position + kRounding && found.rotation <= allowed.rotation + kRounding &&
         found.force <= allowed.force + kRounding && found.couple <= allowed.couple + kRounding;
}

AdamsError largest_error(const AdamsCase& one, const Scene& scene, const test::AdamsTable& table) {
  const auto truth = make_truth("reference", scene, kDuration);
  BOOST_TEST(truth->error(kDuration) < 1e-9);
  GroundLoads loads(scene, one.marker);
  AdamsError largest;
  for (const AdamsFigures& printed : table) {
    const BodyTable state = test::truth_at(*truth, printed.time, 1);
    keep_largest(largest, beyond_rounding(loads.at(state.columns(), printed.time), printed, one.digits));
  }
  return largest;
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_case_has_figures_of_five_instants_and_all_figures_are_of_a_case) {
  BOOST_TEST(cited().size() == all_cases().size());
  std::vector<std::string> ids;
  for (const std::string& id : suite_ids(default_suite_dir())) {
    if (id.starts_with("published/adams-")) ids.push_back(id);
  }
  BOOST_TEST_REQUIRE(ids.size() == all_cases().size());
  for (std::size_t k = 0; k < ids.size(); ++k) {
    BOOST_TEST(path_of(all_cases()[k]) == ids[k]);
    BOOST_TEST_REQUIRE(cited().contains(ids[k]));
    BOOST_TEST(cited().at(ids[k]).size() == 5);
  }
}

BOOST_AUTO_TEST_CASE(the_truth_and_its_loads_meet_the_cited_figures) {
  for (const AdamsCase& one : all_cases()) {
    const AdamsError found = largest_error(one, test::suite_scene(path_of(one)), cited().at(path_of(one)));
    BOOST_TEST_CONTEXT(one.id << ": " << found) BOOST_TEST(is_within(found, one.error));
  }
}

// The file's truth where it is a closed form; the others are the reference itself.
BOOST_AUTO_TEST_CASE(closed_forms_meet_the_cited_figures) {
  for (const auto& [id, kind] : {std::pair{"adams-prismatic-1", "slider"},
                                 {"adams-prismatic-2", "slider"},
                                 {"adams-revolute-1", "pendulum"},
                                 {"adams-spring-1", "oscillator"}}) {
    const auto one = std::find_if(all_cases().begin(), all_cases().end(), [&](const auto& c) { return c.id == id; });
    const Scene scene = test::suite_scene(path_of(*one));
    const auto truth = make_truth(kind, scene, kDuration);
    for (const AdamsFigures& printed : cited().at(path_of(*one))) {
      const BodyState body = test::truth_at(*truth, printed.time, 1).columns().body(0);
      BOOST_TEST(test::beyond_rounding(body.position, printed.position, one->digits) <=
                 one->error.position + kRounding);
      BOOST_TEST(angle_between(body.orientation, printed.orientation) < 4 * test::half_digit(0.5, one->digits));
    }
  }
}

BOOST_AUTO_TEST_CASE(the_best_method_meets_the_cited_figures_at_1_240) {
  for (const AdamsCase& one : all_cases()) {
    const Scene scene = test::suite_scene(path_of(one));
    AdamsError largest;
    GroundLoads loads(scene, one.marker);
    for (const AdamsFigures& printed : cited().at(path_of(one))) {
      const BodyTable state = test::state_after(scene, "dormand-prince", 1.0 / 240, printed.time);
      keep_largest(largest, beyond_rounding(loads.at(state.columns(), printed.time), printed, one.digits));
    }
    BOOST_TEST_CONTEXT(one.id << ": " << largest) BOOST_TEST(is_within(largest, one.error));
  }
}

// Gravity of 9.81 instead of 9.80665 m/s², which a reader of the models could take.
BOOST_AUTO_TEST_CASE(another_gravity_misses_the_figures_of_every_case) {
  for (const AdamsCase& one : all_cases()) {
    Scene scene = test::suite_scene(path_of(one));
    scene.gravity.z() = -9.81;
    const AdamsError found = largest_error(one, scene, cited().at(path_of(one)));
    BOOST_TEST_CONTEXT(one.id << ": " << found) BOOST_TEST(!is_within(found, one.error));
  }
}

// Loads on the rod instead of the ground, and couples about the rod's centre, are noticed wherever they differ.
BOOST_AUTO_TEST_CASE(another_convention_of_loads_misses_the_figures) {
  int turned = 0, moved = 0;
  for (const AdamsCase& one : all_cases()) {
    test::AdamsTable table = cited().at(path_of(one));
    const Scene scene = test::suite_scene(path_of(one));
    if (std::ranges::any_of(table, [](const auto& row) { return row.force.norm() > 1e-3; })) {
      ++turned;
      for (AdamsFigures& row : table) row.force = -row.force;
      BOOST_TEST_CONTEXT(one.id) BOOST_TEST(!is_within(largest_error(one, scene, table), one.error));
    }
    table = cited().at(path_of(one));
    if (std::ranges::any_of(
            table, [&](const auto& row) { return (row.position - one.marker).cross(row.force).norm() > 1e-3; })) {
      ++moved;
      for (AdamsFigures& row : table) row.couple += (one.marker - row.position).cross(row.force);
      BOOST_TEST_CONTEXT(one.id) BOOST_TEST(!is_within(largest_error(one, scene, table), one.error));
    }
  }
  BOOST_TEST(turned == 16);  // not those that fall freely along their joint: actuator-1, cylindrical-1, prismatic-1
  BOOST_TEST(moved == 13);   // nor those whose force points to the centre: distance-1, spring-1, spring-2
}

// The whole tables, each of 501 instants, where RIGOR_DATA has them. With --log_level=all the differences are printed.
BOOST_AUTO_TEST_CASE(the_truth_meets_the_whole_tables) {
  if (test::adams_folder().empty()) {
    BOOST_TEST_MESSAGE("not compared: RIGOR_DATA does not name the folder of the tables");
    return;
  }
  for (const AdamsCase& one : all_cases()) {
    const test::AdamsTable table = whole_adams_table(test::adams_folder(), one);
    BOOST_TEST_REQUIRE(table.size() == 501);
    const AdamsError found = largest_error(one, test::suite_scene(path_of(one)), table);
    AdamsCase to_every_digit = one;
    to_every_digit.digits = 17;
    BOOST_TEST_MESSAGE(one.id << ": " << largest_error(to_every_digit, test::suite_scene(path_of(one)), table) << "; "
                              << found << " beyond rounding");
    BOOST_TEST_CONTEXT(one.id << ": " << found) BOOST_TEST(is_within(found, one.error));
  }
}

BOOST_AUTO_TEST_SUITE_END()
