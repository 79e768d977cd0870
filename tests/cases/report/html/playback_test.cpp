#include "cases/report/html/playback.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>

#include "tests/cases/report/html/unpacking.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_html_playback)

namespace {

Scene one_ball() {
  Scene scene;
  scene.gravity = Vec3(0, -10, 0);
  Body ball;
  ball.name = "ball", ball.shape = Sphere{0.1};
  scene.bodies.push_back(ball);
  return scene;
}

// A ball that bounces elastically from 1.25 m: half a second down, one second from impact to impact, while it spins.
Trajectory bouncing(double seconds, double dt) {
  Trajectory run{.dt = dt, .samples = {}};
  for (int n = 0; n * dt <= seconds + 1e-9; ++n) {
    const double t = n * dt, since_apex = std::remainder(t, 1.0);
    Sample sample{t, BodyTable(1)};
    BodyState state;
    state.position = Vec3(0.3 * t, 1.25 - 5 * since_apex * since_apex, 0);
    state.velocity = Vec3(0.3, -10 * since_apex, 0);
    state.orientation = Quat(std::cos(2 * t), 0, std::sin(2 * t), 0);
    sample.bodies.columns().set_body(0, state);
    run.samples.push_back(sample);
  }
  return run;
}

// The body's position at `time` on the page: on the straight line between two keys.
Vec3 position_at(const UnpackedRun& run, double time) {
  std::size_t k = 0;
  while (k + 2 < run.keys.size() && run.keys[k + 1] * run.interval <= time) ++k;
  const double from = run.keys[k] * run.interval, to = std::min(run.keys[k + 1] * run.interval, run.last);
  return run.positions[k] + (time - from) / (to - from) * (run.positions[k + 1] - run.positions[k]);
}

JudgedRun judged(const Scene& scene, const Trajectory& run, const TruthSamples* truth = nullptr) {
  return {scene, run, truth, 0};
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_thinned_motion_stays_close_and_keeps_its_impacts) {
  const Scene scene = one_ball();
  const Trajectory run = bouncing(5, 1e-3);
  const UnpackedRun page = unpacked_run(packed_run(judged(scene, run), {}, 1, 300000).front());
  BOOST_TEST(page.keys.size() < run.samples.size() / 10);
  BOOST_TEST(page.last == 5.0, boost::test_tools::tolerance(1e-12));
  for (const Sample& sample : run.samples) {
    // What is seen is a thousandth of the motion's extent, some 2 m; a 65536th of it comes from rounding.
    const double off = (position_at(page, sample.time) - sample.bodies.columns().position(0)).norm();
    BOOST_TEST(off < 2.1e-3, "off by " << off << " m at " << sample.time << " s");
    if (off >= 2.1e-3) break;
  }
  for (const double impact : {0.5, 1.5, 2.5, 3.5, 4.5}) BOOST_TEST(position_at(page, impact).y() < 5e-3);
  for (std::size_t k = 0; k < page.keys.size(); ++k) {
    const Quat exact = run.samples[page.keys[k]].bodies.columns().orientation(0);
    // The page has the quaternion's w from the other three, which is worst where w is 0: there sqrt(2 * 3 / 65535).
    BOOST_TEST(page.orientations[k].angularDistance(exact) < 0.02);
  }
}

BOOST_AUTO_TEST_CASE(packings_go_from_fine_to_coarse_and_keep_the_impacts_as_long_as_there_is_a_motion) {
  const Scene scene = one_ball();
  const Trajectory run = bouncing(5, 1e-3);
  NamedSeries aside{"creep", std::vector<double>(run.samples.size(), 1)};
  const Packings packings = packed_run(judged(scene, run), {aside}, 1, 300000);
  BOOST_TEST_REQUIRE(packings.size() > 5u);
  BOOST_TEST(packings.back().size() < 500u);
  for (std::size_t i = 0; i < packings.size(); ++i) {
    const UnpackedRun page = unpacked_run(packings[i]);
    if (i > 0) BOOST_TEST(packings[i].size() < packings[i - 1].size());
    BOOST_TEST(page.series.size() == (i == 0 ? 2u : 1u));
    if (page.keys.size() < 12) continue;  // two for each impact, and the ends
    for (const double impact : {0.5, 1.5, 2.5, 3.5, 4.5}) BOOST_TEST(position_at(page, impact).y() < 0.05);
  }
}

BOOST_AUTO_TEST_CASE(courses_keep_their_extremes_and_end_where_they_were_compared) {
  const Scene scene = one_ball();
  const Trajectory run = bouncing(5, 1e-3);
  NamedSeries error{"position_error", {}};
  for (int n = 0; n < 3000; ++n) error.values.push_back(1e-9 * std::exp(n / 150.0));
  error.values[1234] = 0.5;  // one sample alone
  const UnpackedRun page = unpacked_run(packed_run(judged(scene, run), {error}, 1, 300000).front());
  BOOST_TEST_REQUIRE(page.series.size() == 2u);
  BOOST_TEST(series_names()[page.series[0]] == kEnergyChange);
  BOOST_TEST(series_names()[page.series[1]] == "position_error");
  double largest = 0;
  for (std::size_t p = 0; p < page.points.size(); ++p) {
    const double value = page.values[1][p];
    if (page.points[p] >= error.values.size()) {
      BOOST_TEST(std::isnan(value));
      continue;
    }
    BOOST_TEST(value == error.values[page.points[p]], boost::test_tools::tolerance(0.004));  // eight bits of mantissa
    largest = std::max(largest, value);
  }
  BOOST_TEST(largest == 0.5, boost::test_tools::tolerance(0.004));
}

BOOST_AUTO_TEST_CASE(a_run_like_the_truth_has_no_motion_of_its_own) {
  const Scene scene = one_ball();
  const Trajectory run = bouncing(2, 0.01);
  TruthSamples truth{{}, std::vector<double>(run.samples.size(), 0), 1};
  for (const Sample& sample : run.samples) truth.bodies.push_back(sample.bodies);
  const UnpackedRun same = unpacked_run(packed_run(judged(scene, run, &truth), {}, 1, 300000).front());
  BOOST_TEST(same.is_like_truth);
  BOOST_TEST(same.keys.empty());
  truth.bodies[77].columns().set_position(0, truth.bodies[77].columns().position(0) + Vec3(0, 0.05, 0));
  BOOST_TEST(!unpacked_run(packed_run(judged(scene, run, &truth), {}, 1, 300000).front()).is_like_truth);
}

BOOST_AUTO_TEST_CASE(a_run_that_leaves_the_picture_is_shown_until_then) {
  const Scene scene = one_ball();
  Trajectory run = bouncing(2, 0.01);
  for (std::size_t n = 100; n < run.samples.size(); ++n)
    run.samples[n].bodies.columns().set_position(0, Vec3(0, std::pow(10.0, n), 0));
  const UnpackedRun page = unpacked_run(packed_run(judged(scene, run), {}, 1, 300000).front());
  BOOST_TEST(page.keys.back() >= 98u);
  BOOST_TEST(page.keys.back() <= 102u);
  for (const Vec3& position : page.positions) BOOST_TEST(position.norm() < 200);
}

// A ball that rests on two points of body 1, which an engine tells in either order; the force jumps once.
BOOST_AUTO_TEST_CASE(contact_forces_are_the_resultants_of_pairs_and_keep_their_spikes) {
  const Scene scene = one_ball();
  Trajectory run = bouncing(2, 1e-3);
  for (std::size_t n = 0; n < run.samples.size(); ++n) {
    const double size = n == 777 ? 5000 : 30;
    run.samples[n].contacts = {{0, 1, Vec3(1, 0, 0), Vec3::UnitY(), 0, Vec3(2, size, 0)},
                               {1, 0, Vec3(4, 0, 3), -Vec3::UnitY(), 0, Vec3(0, -2 * size, 0)}};
  }
  const UnpackedRun page = unpacked_run(packed_run(judged(scene, run), {}, 1, 300000).front());
  BOOST_TEST_REQUIRE(page.forces.size() == 1u);
  const UnpackedForces& pair = page.forces.front();
  BOOST_TEST(pair.a == 0);
  BOOST_TEST(pair.b == 1);
  bool has_spike = false;
  for (std::size_t p = 0; p < page.points.size(); ++p) {
    const double size = page.points[p] == 777 ? 5000 : 30;
    has_spike = has_spike || page.points[p] == 777;
    // A third of the way, weighted with the forces; forces have eight bits of mantissa.
    BOOST_TEST((pair.points[p] - Vec3(3, 0, 2)).norm() < 1e-4);
    BOOST_TEST((pair.forces[p] - Vec3(2, 3 * size, 0)).norm() < 0.004 * 3 * size);
    BOOST_TEST((pair.normals[p] - Vec3::UnitY()).norm() < 1e-4);
  }
  BOOST_TEST(has_spike);
}

BOOST_AUTO_TEST_CASE(forces_of_the_strongest_pairs_are_kept_and_what_does_not_touch_has_none) {
  const Scene scene = one_ball();
  Trajectory run = bouncing(1, 0.01);
  for (int b = 1; b <= 20; ++b)
    run.samples[static_cast<std::size_t>(b)].contacts = {{0, b, Vec3::Zero(), Vec3::UnitY(), 0, Vec3(0, b, 0)}};
  const UnpackedRun page = unpacked_run(packed_run(judged(scene, run), {}, 1, 300000).front());
  BOOST_TEST_REQUIRE(page.forces.size() == 8u);
  for (const UnpackedForces& pair : page.forces) {
    BOOST_TEST(pair.b > 12);
    for (std::size_t p = 0; p < page.points.size(); ++p) {
      const bool touches = page.points[p] == static_cast<std::size_t>(pair.b);
      BOOST_TEST((pair.forces[p].norm() > 0) == touches);
      BOOST_TEST((pair.normals[p].norm() > 0) == touches);
    }
  }
  BOOST_TEST(unpacked_run(packed_run(judged(scene, bouncing(1, 0.01)), {}, 1, 300000).front()).forces.empty());
}

BOOST_AUTO_TEST_CASE(no_sample_is_no_trouble) {
  const Scene scene = one_ball();
  BOOST_TEST(packed_run(judged(scene, Trajectory{}), {}, 1, 300000).empty());
  Trajectory start = bouncing(0, 0.01);
  const UnpackedRun page = unpacked_run(packed_run(judged(scene, start), {}, 0, 300000).front());
  BOOST_TEST(page.keys.size() == 1u);
}

BOOST_AUTO_TEST_CASE(no_packing_is_longer_than_its_limit) {
  const Scene scene = one_ball();
  const Trajectory run = bouncing(5, 1e-3);
  for (const std::size_t limit : {400u, 700u, 1000u}) {  // at its finest it has 1100
    const Packings packings = packed_run(judged(scene, run), {}, 1, limit);
    BOOST_TEST_REQUIRE(!packings.empty());
    BOOST_TEST(packings.front().size() <= limit);
    BOOST_TEST(packings.front().size() > limit / 2);
  }
}

BOOST_AUTO_TEST_CASE(the_limit_is_some_even_shares_of_the_page) {
  Results grid;
  CaseResult small, pile;
  small.definition.scene = one_ball();
  pile.definition.scene.bodies.assign(216, Body());
  for (CaseResult* one : {&small, &pile}) {
    one->definition.dt = {{1.0 / 30, "1/30"}, {1.0 / 240, "1/240"}};
    for (std::size_t n = 0; n < 30; ++n) {
      one->cells.emplace_back();
      one->cells.back().dt = one->definition.dt[n % 2];
    }
  }
  for (int i = 0; i < 300; ++i) grid.cases.push_back(i < 5 ? pile : small);
  const PlaybackLimit limit(grid);
  double sum = 0;
  for (const CaseResult& one : grid.cases) {
    sum += limit.of(one.definition, nullptr);
    for (const Cell& cell : one.cells) sum += limit.of(one.definition, &cell.dt);
  }
  BOOST_TEST(sum <= 6 * 6e6);
  BOOST_TEST(sum > 5.9 * 6e6);
  const StepSize &coarse = pile.definition.dt[0], &fine = pile.definition.dt[1];
  BOOST_TEST(limit.of(grid.cases[0].definition, &coarse) > limit.of(grid.cases[0].definition, &fine));
  BOOST_TEST(limit.of(grid.cases[0].definition, &coarse) > 20 * limit.of(grid.cases[299].definition, &coarse));
}

BOOST_AUTO_TEST_CASE(the_page_takes_of_each_run_what_fits) {
  const Scene scene = one_ball();
  const Trajectory run = bouncing(5, 1e-3), still = bouncing(0, 1e-3);
  CaseResult one;
  one.definition.scene = scene, one.definition.dt = {{1.0 / 30, "1/30"}, {1.0 / 240, "1/240"}};
  for (const StepSize& dt : one.definition.dt) {
    one.cells.emplace_back();
    one.cells.back().dt = dt, one.cells.back().recordings["playback"] = packed_run(judged(scene, run), {}, 1, 300000);
  }
  one.cells.emplace_back();
  one.cells.back().dt = one.definition.dt[1],
  one.cells.back().recordings["playback"] = packed_run(judged(scene, still), {}, 1, 300000);
  Results grid;
  for (int i = 0; i < 20; ++i) grid.cases.push_back(one);
  const auto size_of = [&](const PlaybackChoice& choice) {
    std::size_t sum = 0;
    for (const CaseResult& result : grid.cases) {
      for (const Cell& cell : result.cells) sum += choice.of(result, cell).front().size();
    }
    return sum;
  };
  const CaseResult& any = grid.cases[7];
  const PlaybackChoice all(grid, 10'000'000);
  for (const Cell& cell : any.cells) BOOST_TEST((all.of(any, cell).front() == cell.recordings.at("playback").front()));
  const std::size_t half = size_of(all) / 2;
  const PlaybackChoice some(grid, half);
  BOOST_TEST(size_of(some) <= half);
  BOOST_TEST(size_of(some) > half / 2);  // a packing is about 0.7 of the finer one
  BOOST_TEST(some.of(any, any.cells[0]).front().size() >
             some.of(any, any.cells[1]).front().size());  // the coarsest step is looked at
  BOOST_TEST(
      (some.of(any, any.cells[2]).front() == any.cells[2].recordings.at("playback").front()));  // it asks for little
  BOOST_TEST(size_of(PlaybackChoice(grid, 0)) == 0u);
}

BOOST_AUTO_TEST_SUITE_END()
