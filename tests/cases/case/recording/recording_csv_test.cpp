#include <boost/test/unit_test.hpp>

#include "cases/case/recording/recording.h"
#include "tests/core/scene/toml/refusal.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_case_recording_recording_csv)

namespace {

const std::string kPath = "toss.csv";

Scene two_bodies() {
  Scene scene;
  scene.bodies = {test::body("cube", 1, {1, 1, 1}), test::body("ball", 1, {1, 1, 1})};
  return scene;
}

std::vector<RecordedTrial> trials_in(const std::string& text, const std::string& group = "",
                                     const Scene& scene = two_bodies()) {
  return read_trials(text, kPath, group, scene);
}

// With the header's line before them.
const std::string kHeader = "time,body,px,py,pz,qw,qx,qy,qz\n";
const std::string kRow = "0,cube,0,0,0,1,0,0,0\n";

}  // namespace

BOOST_AUTO_TEST_CASE(columns_in_any_order_among_others_and_with_gaps) {
  const std::string text =
      "camera,pz,time,py,px,body\r\n3,0.3,1.5,0.2,0.1,cube\r\n\r\n3, 0.31 ,1.6,0.2,0.1,cube\n3,0.5,2.6,0.2,0.1,cube";
  const auto trials = trials_in(text);
  BOOST_TEST_REQUIRE(trials.size() == 1u);
  const RecordedBody& cube = trials[0].bodies.at(0);
  BOOST_TEST(cube.body == 0);
  BOOST_TEST_REQUIRE(cube.times.size() == 3u);
  BOOST_TEST(cube.times[0] == 0.0);
  BOOST_TEST(cube.times[2] == 2.6 - 1.5);
  BOOST_TEST(trials[0].duration == 2.6 - 1.5);
  BOOST_TEST((cube.positions[1] == Vec3(0.1, 0.2, 0.31)));
  BOOST_TEST(cube.orientations.empty());
  BOOST_TEST(cube.velocities.empty());
}

BOOST_AUTO_TEST_CASE(trials_in_the_order_in_which_they_come_with_their_bodies) {
  const std::string text =
      "toss,time,body,px,py,pz\nb,0,cube,1,0,0\nb,0,ball,2,0,0\nb,1,cube,1,0,0\nb,0.5,ball,2,0,0\n"
      "a,7,cube,3,0,0\na,9,cube,3,0,0\n";
  const auto trials = trials_in(text, "toss");
  BOOST_TEST_REQUIRE(trials.size() == 2u);
  BOOST_TEST(trials[0].name == "b");
  BOOST_TEST(trials[0].bodies.size() == 2u);
  BOOST_TEST(trials[0].duration == 0.5);  // the ball was recorded shortest
  BOOST_TEST(trials[1].name == "a");
  BOOST_TEST(trials[1].duration == 2.0);
}

BOOST_AUTO_TEST_CASE(without_a_column_of_bodies_the_only_one_that_moves_is_meant) {
  Scene scene = two_bodies();
  scene.bodies[0].fixed = true;
  const auto trials = trials_in("time,px,py,pz\n0,1,2,3\n1,1,2,3\n", "", scene);
  BOOST_TEST(trials.at(0).bodies.at(0).body == 1);
  check_refusal({"", "1:1: ", {"no column 'body'", "2 bodies"}}, kPath, [] { trials_in("time,px,py,pz\n0,1,2,3\n"); });
}

BOOST_AUTO_TEST_CASE(quaternions_with_few_digits_become_unit_ones) {
  const auto trials = trials_in(kHeader + "0,cube,0,0,0,0.7071,0.7071,0,0\n1,cube,0,0,0,1,0,0,0\n");
  BOOST_TEST(std::abs(trials[0].bodies[0].orientations[0].norm() - 1) < 1e-15);
}

BOOST_AUTO_TEST_CASE(bad_files_are_refused_with_line_and_column) {
  const std::vector<Refusal> rows = {
      {"body,px,py,pz\n", "1:1: ", {"no column 'time'"}},
      {"time,body,px,py\n0,cube,1,2\n", "1:1: ", {"no column 'pz'", "px, py, pz, or none"}},
      {"time,body,vx,vy,vz\n", "1:1: ", {"neither px, py, pz nor qw"}},
      {"time,time,body,px,py,pz\n", "1:1: ", {"'time' is there twice"}},
      {kHeader, "1:1: ", {"no row below the header"}},
      {kHeader + kRow + "0,cube,0,0,0,1,0,0,0\n", "3:1: ", {"the time 0 s of 'cube' after 0 s", "truth.group"}},
      {kHeader + "1,cube,0,0,0,1,0,0,0\n0.5,cube,0,0,0,1,0,0,0\n", "3:1: ", {"0.5 s of 'cube' after 1 s"}},
      {kHeader + "0,cub,0,0,0,1,0,0,0\n", "2:3: ", {"no body 'cub'", "did you mean 'cube'?"}},
      {kHeader + "0,cube,0,0,0,1,0.1,0,0\n", "2:14: ", {"length 1.005", "unit quaternion"}},
      {kHeader + "0,cube,0,0,0,0,0,0,0\n", "2:14: ", {"length 0"}},
      {kHeader + "0,cube,nan,0,0,1,0,0,0\n", "2:8: ", {"px: found 'nan'", "finite"}},
      {kHeader + "0,cube,0,inf,0,1,0,0,0\n", "2:10: ", {"py: found 'inf'"}},
      {kHeader + "0,cube,0,,0,1,0,0,0\n", "2:10: ", {"py: found ''"}},
      {kHeader + "0,cube,0,0,0,1,0,0\n", "2:19: ", {"found 8 columns", "allowed: 9"}},
      {kHeader + kRow, " ", {"one sample of 'cube'", "two or more"}},
      {kHeader + kRow + "1,cube,0,0,0,1,0,0,0\n1,ball,0,0,0,1,0,0,0\n2,ball,0,0,0,1,0,0,0\n",
       " ",
       {"'ball' begins at 1 s", "0 s"}},
  };
  for (const Refusal& row : rows) check_refusal(row, kPath, [&] { trials_in(row.text); });
}

BOOST_AUTO_TEST_CASE(a_column_of_trials_that_is_not_there_is_refused_with_a_near_match) {
  check_refusal({"", "1:1: ", {"no column 'tos'", "did you mean 'toss'?"}}, kPath,
                [] { trials_in("toss,time,body,px,py,pz\n1,0,cube,0,0,0\n1,1,cube,0,0,0\n", "tos"); });
  check_refusal({"", "2:1: ", {"toss is empty"}}, kPath,
                [] { trials_in("toss,time,body,px,py,pz\n,0,cube,0,0,0\n", "toss"); });
}

BOOST_AUTO_TEST_CASE(a_fit_of_the_start_finds_a_parabola_and_an_even_turn_again) {
  const Vec3 p(1, 2, 3), v(0.3, -0.2, 0.5), g(0, 0, -9.81), w(1.1, 0.7, -0.9);
  const Quat q = Quat(0.8, 0.2, -0.4, 0.4).normalized();
  RecordedBody body;
  for (int i = 0; i < 9; ++i) {
    const double t = 0.01 * i * (1 + 0.1 * i);  // irregular
    body.times.push_back(t);
    body.positions.push_back(p + t * v + 0.5 * t * t * g);
    body.orientations.push_back(rotation_by(t * w) * q);
  }
  MotionRecording recording;
  recording.start_fit = 9;
  recording.trials = {{"", {body}, body.times.back()}};
  Scene scene = two_bodies();
  start_from(recording, 0, scene);
  BOOST_TEST((scene.bodies[0].position - p).norm() < 1e-12);
  BOOST_TEST((scene.bodies[0].velocity - v).norm() < 1e-11);
  BOOST_TEST(angle_between(scene.bodies[0].orientation, q) < 1e-12);
  BOOST_TEST((scene.bodies[0].angular_velocity - w).norm() < 1e-11);
  BOOST_TEST((scene.bodies[1].position == Vec3(Vec3::Zero())));  // not recorded
}

BOOST_AUTO_TEST_SUITE_END()
