// `rigor truth --reactions` and `rigor trace --reactions`, for a rod that is released level. The equations of a
// compound pendulum, which share no code with Rigor, say what its joint carries.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <sstream>

#include "tests/cases/cli/program.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_csv_reaction_csv)

namespace {

constexpr double kMass = 2, kArm = 0.5, kAboutPivot = 0.7, kGravity = 9.81;  // kg, m, kg m², m/s²

const char* const kRod = R"(
title = "a rod"
source = "a test"
[scene]
gravity = [0, -9.81, 0]
[[scene.body]]
name = "rod"
mass = 2
inertia = [0.2, 0.2, 0.2]
position = [0.5, 0, 0]
[[scene.joint]]
name = "pivot"
type = "hinge"
a = "world"
b = "rod"
anchor = [0, 0, 0]
axis = [0, 0, 1]
[run]
duration = 0.5
dt = ["1/2000"]
[truth]
kind = "reference"
)";

struct Row {
  double time;
  std::string joint;
  Vec3 point, force, couple;
};

std::vector<Row> rows_of(const std::string& csv) {
  std::istringstream in(csv);
  std::string line;
  std::getline(in, line);
  BOOST_TEST(line == "time,joint,px,py,pz,fx,fy,fz,tx,ty,tz");
  std::vector<Row> rows;
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    Row row;
    fields >> row.time >> row.joint;
    for (Vec3* vector : {&row.point, &row.force, &row.couple}) {
      for (int k = 0; k < 3; ++k) fields >> (*vector)[k];
    }
    BOOST_TEST(!fields.fail(), line);
    rows.push_back(row);
  }
  return rows;
}

// N: on the rod, at an angle [rad] below the horizontal after a release from it.
Vec3 carried_at(double below) {
  const double rate_squared = 2 * kMass * kGravity * kArm * std::sin(below) / kAboutPivot;
  const double acceleration = kMass * kGravity * kArm * std::cos(below) / kAboutPivot;
  const Vec3 along(std::cos(below), -std::sin(below), 0), across(-std::sin(below), -std::cos(below), 0);
  return kMass * (kArm * (acceleration * across - rate_squared * along) + Vec3(0, kGravity, 0));
}

// rad below the horizontal, at t [s]: the steps of a fine Verlet scheme.
double fallen_at(double t) {
  constexpr int kSteps = 200000;
  const double dt = t / kSteps;
  double below = 0, rate = 0;
  const auto acceleration = [](double angle) { return kMass * kGravity * kArm * std::cos(angle) / kAboutPivot; };
  for (int n = 0; n < kSteps; ++n) {
    rate += dt / 2 * acceleration(below);
    below += dt * rate;
    rate += dt / 2 * acceleration(below);
  }
  return below;
}

struct WithRod : Program {
  WithRod() { folder.write("rod.toml", kRod); }
  std::string rod() const { return (folder.path / "rod.toml").string(); }
};

}  // namespace

BOOST_FIXTURE_TEST_CASE(the_truth_says_what_a_pendulum_carries, WithRod) {
  const Answer answer = run({"truth", rod(), "--reactions", "--times", "0,0.25,0.5"});
  BOOST_TEST(answer.code == 0, answer.err);
  const std::vector<Row> rows = rows_of(answer.out);
  BOOST_REQUIRE(rows.size() == 3u);
  for (const Row& row : rows) {
    BOOST_TEST(row.joint == "pivot");
    // The truth's error is below 1e-9 m; the Verlet scheme's is 1e-11 rad.
    BOOST_TEST((row.force - carried_at(row.time > 0 ? fallen_at(row.time) : 0)).norm() < 1e-7);
    BOOST_TEST(row.couple.norm() < 1e-7);
    BOOST_TEST(row.point.norm() < 1e-8);
  }
}

// ODE is of first order, so half a step halves what its loads are off by.
BOOST_FIXTURE_TEST_CASE(an_engine_says_what_it_carries_itself, WithRod) {
  const Vec3 expected = carried_at(fallen_at(0.5));
  std::vector<double> errors;
  for (const int steps : {500, 1000, 2000}) {
    const std::string dt = "1/" + std::to_string(2 * steps);
    const Answer answer = run({"trace", rod(), "--engine", "ode", "--dt", dt, "--reactions"});
    BOOST_TEST(answer.code == 0, answer.err);
    const std::vector<Row> rows = rows_of(answer.out);
    BOOST_REQUIRE(rows.size() == static_cast<std::size_t>(steps - 1));  // from the second step on
    BOOST_TEST(rows.front().time == 1.0 / steps, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(rows.back().time == 0.5, boost::test_tools::tolerance(1e-12));
    errors.push_back((rows.back().force - expected).norm());
  }
  BOOST_TEST(errors[0] / errors[1] == 2, boost::test_tools::tolerance(0.1));
  BOOST_TEST(errors[1] / errors[2] == 2, boost::test_tools::tolerance(0.1));
  BOOST_TEST(errors[2] < 0.01 * expected.norm());
}

BOOST_FIXTURE_TEST_CASE(what_cannot_be_printed_is_refused, WithRod) {
  const auto refused = [&](std::vector<std::string> words, const std::string& because) {
    const Answer answer = run(words);
    BOOST_TEST(answer.code == 2);
    BOOST_TEST(answer.out.empty());
    BOOST_TEST(answer.err.find(because) != std::string::npos, answer.err);
  };
  refused({"trace", rod(), "--engine", "core:rk4", "--reactions"}, "does not say what its joints carry");
  refused({"trace", rod(), "--engine", "ode", "--reactions", "--every", "2"}, "takes no --every");
  refused({"trace", rod(), "--engine", "ode", "--reactions", "--contacts"}, "two tables");
  refused({"trace", rod(), "--engine", "ode", "--reactions", "--format", "mcap"}, "csv only");
  refused({"truth", "springs/fixed-spring", "--reactions"}, "no joints");
  refused({"truth", "joints/pendulum-at-stop", "--reactions"}, "has limits");
  refused({"truth", "reality/synthetic-tosses", "--reactions"}, "a recording does not say what joints carry");
}

BOOST_AUTO_TEST_SUITE_END()
