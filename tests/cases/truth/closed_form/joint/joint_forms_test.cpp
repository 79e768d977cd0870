// The closed forms of jointed bodies, compared with independent states and periods, with the reference, which uses no
// elliptic function, and on scenes outside their validity.
#include <boost/test/unit_test.hpp>

#include <algorithm>

#include "core/base/error.h"
#include "tests/cases/judged.h"
#include "tests/cases/suite/suite_checks.h"
#include "tests/core/dynamics/joints/jointed_run.h"
#include "tests/core/dynamics/joints/published_states.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_closed_form_joint_joint_forms)

namespace {

const char* const kOfJoints[] = {"cardan-shaft", "heavy-top",         "linkage", "pendulum",
                                 "slider",       "steady-precession", "welded"};

bool is_of_joints(const Case& c) {
  return !c.scene.joints.empty() &&
         std::find(std::begin(kOfJoints), std::end(kOfJoints), c.truth) != std::end(kOfJoints);
}

BodyState state_at(const Truth& truth, double t, const Scene& scene, std::size_t body) {
  return test::truth_at(truth, t, scene.bodies.size()).columns().body(body);
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_published_state_is_met) {
  std::vector<std::string> truths;  // that met one, once each time
  for (const Case& c : test::suite_cases(is_of_joints)) {
    const auto truth = make_truth(c.truth, c.scene, c.duration);
    for (const test::PublishedState& published : test::kPublishedStates) {
      if (published.scene != c.id) continue;
      const BodyState found = state_at(*truth, published.time, c.scene, test::body_index(c.scene, published.body));
      const test::Difference off = test::difference(found, published.state);
      // Their own uncertainty, which for an angle is twice that of a quaternion's components, and the rounding of the
      // printed numbers of up to 100 rad/s.
      BOOST_TEST_CONTEXT(c.id << " at " << published.time << " s, " << published.body) {
        BOOST_TEST(off.pose <= 4 * published.error + 1e-14);
        BOOST_TEST(off.velocity <= 2 * published.error + 1e-13);
      }
      truths.push_back(c.truth);
    }
  }
  BOOST_TEST(truths.size() >= 36);
  for (const char* truth : kOfJoints) BOOST_TEST(std::count(truths.begin(), truths.end(), truth) > 0, truth);
}

// Whole periods, as published to fourteen digits.
BOOST_AUTO_TEST_CASE(each_pendulum_comes_back_after_its_period) {
  struct Row {
    const char* scene;
    double period;  // s
  };
  for (const Row& row : {Row{"joints/pendulum-small", 1.639238553061},
                         {"joints/pendulum-90", 1.9339389271436},
                         {"joints/pendulum-179", 6.3917328415959},
                         {"joints/pendulum-over-the-top", 1.9813145542486},
                         {"joints/iftomm-a01", 2.3678419475762},
                         {"joints/chrono-revolute", 4.0323786384},
                         {"mechanisms/trammel", 3.3331829074033},
                         {"mechanisms/iftomm-a02-2", 1.9425149226071},
                         {"mechanisms/iftomm-a02-40", 1.9656019287047}}) {
    const Scene scene = test::suite_scene(row.scene);
    const auto cases = test::suite_cases([&](const Case& c) { return c.id == row.scene; });
    const auto truth = make_truth(cases.at(0).truth, scene, row.period);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const test::Difference off =
          test::difference(state_at(*truth, row.period, scene, i), state_at(*truth, 0, scene, i));
      // Half of the period's last digit at some 10 m/s and 100 m/s².
      BOOST_TEST_CONTEXT(row.scene) BOOST_TEST(off.pose + off.velocity < 1e-10);
    }
  }
}

// The reference is solved from the joints' rows. Not where the motion passes a singular position, which it cannot.
BOOST_AUTO_TEST_CASE(the_reference_comes_to_the_same) {
  for (const Case& c : test::suite_cases(is_of_joints)) {
    if (c.id.find("a02") != std::string::npos) continue;
    constexpr double kEnd = 1;  // s
    const auto closed = make_truth(c.truth, c.scene, kEnd), solved = make_truth("reference", c.scene, kEnd);
    for (const double t : {0.3, kEnd}) {
      for (std::size_t i = 0; i < c.scene.bodies.size(); ++i) {
        const test::Difference off =
            test::difference(state_at(*closed, t, c.scene, i), state_at(*solved, t, c.scene, i));
        BOOST_TEST_CONTEXT(c.id << " at " << t << " s")
        BOOST_TEST(off.pose <= closed->error(t) + solved->error(t) + 1e-14);  // of the scene's own joints: 1e-16, grown
      }
    }
  }
}

// A pendulum that swings keeps to itself whichever way its joint is written.
BOOST_AUTO_TEST_CASE(a_joint_the_other_way_round_is_the_same_joint) {
  for (const Case& c : test::suite_cases(is_of_joints)) {
    Scene other = c.scene;
    for (Joint& joint : other.joints) {
      std::swap(joint.a, joint.b);
      if (auto* distance = std::get_if<DistanceJoint>(&joint.type)) std::swap(distance->point_a, distance->point_b);
    }
    const auto one = make_truth(c.truth, c.scene, 2), same = make_truth(c.truth, other, 2);
    for (std::size_t i = 0; i < c.scene.bodies.size(); ++i) {
      const test::Difference off = test::difference(state_at(*one, 1.7, c.scene, i), state_at(*same, 1.7, other, i));
      BOOST_TEST_CONTEXT(c.id) BOOST_TEST(off.pose + off.velocity < 1e-13);  // roundings of 40 rad/s
    }
  }
}

BOOST_AUTO_TEST_CASE(a_scene_it_does_not_hold_for_is_refused_with_the_reason) {
  struct Row {
    const char* truth;
    const char* scene;
    void (*spoil)(Scene&);
    const char* says;
  };
  const Row rows[] = {
      {"pendulum", "joints/pendulum-90", [](Scene& s) { s.joints.push_back(s.joints[0]); }, "there are 2 joints"},
      {"pendulum", "joints/pendulum-90", [](Scene& s) { s.joints[0].damping = 1; }, "joint-damper"},
      {"pendulum", "joints/pendulum-90", [](Scene& s) { s.joints[0].upper = 1; }, "joint-limit"},
      {"pendulum", "joints/pendulum-90",
       [](Scene& s) {
         s.bodies[0].velocity = {0, 1, 0};
       },
       "does not move with"},
      {"pendulum", "joints/pendulum-90", [](Scene& s) { s.bodies.push_back(s.bodies[0]); }, "2 bodies move"},
      {"pendulum", "joints/pendulum-ball",
       [](Scene& s) { s.bodies[0].inertia(0, 2) = s.bodies[0].inertia(2, 0) = 1e-4; }, "no principal axis"},
      {"pendulum", "joints/pendulum-ball",
       [](Scene& s) {
         s.gravity = {0, 0, -9.81}, s.bodies[0].angular_velocity = {0, 0, 1}, s.bodies[0].velocity = {0, 0.5, 0};
       },
       "gravity pulls it out of the plane"},
      {"pendulum", "joints/spherical-pendulum", [](Scene&) {}, "gravity pulls it out of the plane"},
      {"pendulum", "joints/conical-rod", [](Scene&) {}, "it swings round a cone"},
      {"pendulum", "joints/iftomm-a01",
       [](Scene& s) {
         std::get<DistanceJoint>(s.joints[0].type).point_b = {0, 0.1, 0};
       },
       "at (0, 0.1, 0)"},
      {"heavy-top", "joints/lagrange-top", [](Scene& s) { s.bodies[0].inertia(0, 0) *= 1.1; }, "is not symmetric"},
      {"heavy-top", "joints/lagrange-top", [](Scene& s) { s.gravity.setZero(); }, "no gravity"},
      {"heavy-top", "joints/pendulum-ball", [](Scene& s) { s.bodies[0].inertia = Vec3(0.01, 0.08, 0.08).asDiagonal(); },
       "the vertical"},
      {"heavy-top", "joints/heavy-top", [](Scene&) {}, "too near the vertical"},
      {"slider", "joints/slider-oscillator",
       [](Scene& s) {
         s.springs[0].point_a = {0.1, 0, 0};
       },
       "not along the rail"},
      {"slider", "joints/slider-oscillator", [](Scene& s) { s.bodies[0].velocity *= -40; }, "passes the spring's"},
      {"slider", "joints/slider-incline",
       [](Scene& s) {
         s.bodies[0].velocity = {1, 0, 0};
       },
       "not along the rail"},
      {"slider", "joints/slider-incline",
       [](Scene& s) {
         s.bodies[0].angular_velocity = {1, 0, 0};
       },
       "it turns"},
      {"linkage", "mechanisms/trammel", [](Scene& s) { s.bodies[0].mass = 2; }, "inertia about the angle changes"},
      {"linkage", "mechanisms/four-bar", [](Scene&) {}, "would part as it turns"},
      {"linkage", "mechanisms/slider-crank", [](Scene&) {}, "would part as it turns"},
      {"linkage", "mechanisms/cardan-shaft", [](Scene&) {}, "its hinges are not parallel"},
      {"cardan-shaft", "mechanisms/four-bar", [](Scene& s) { s.gravity.setZero(); }, "an arm of the cross"},
      {"cardan-shaft", "mechanisms/cardan-shaft",
       [](Scene& s) {
         s.gravity = {0, 0, -9.81};
       },
       "gravity acts"},
      {"cardan-shaft", "mechanisms/cardan-shaft",
       [](Scene& s) { s.bodies[1].inertia(0, 1) = s.bodies[1].inertia(1, 0) = 1e-4; }, "no principal axes"},
      {"cardan-shaft", "mechanisms/cardan-shaft", [](Scene& s) { s.bodies[2].angular_velocity *= 1.01; },
       "'driven' does not move with the rest"},
      {"cardan-shaft", "mechanisms/cardan-shaft",
       [](Scene& s) {
         std::get<HingeJoint>(s.joints[3].type).anchor = {0.01, 0, 0};
       },
       "do not meet in one point"},
      {"cardan-shaft", "mechanisms/cardan-shaft", [](Scene& s) { s.joints.pop_back(); }, "no two bodies turn"},
      {"welded", "joints/welded-pair", [](Scene& s) { s.bodies[1].velocity.x() += 0.1; },
       "does not move with the rest"},
      {"welded", "joints/welded-pair", [](Scene& s) { s.bodies.push_back(s.bodies[1]); }, "is not fixed to the rest"},
      {"welded", "joints/welded-pair", [](Scene& s) { s.joints[0].b = kWorld; }, "what stands still"},
  };
  for (const Row& row : rows) {
    Scene scene = test::suite_scene(row.scene);
    row.spoil(scene);
    BOOST_TEST_CONTEXT(row.truth << " of " << row.scene << ": " << row.says)
    BOOST_CHECK_EXCEPTION(make_truth(row.truth, scene, 10), InputError, test::says(row.says));
  }
}

BOOST_AUTO_TEST_SUITE_END()
