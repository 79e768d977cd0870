// Results of a chain of bodies, with gaps and settings that a test states.
#pragma once

#include <boost/test/unit_test.hpp>

#include "tests/cases/report/sample_results.h"
#include "tests/scenes.h"

namespace rigor::test {

// Rods of 1 m and 1 kg on ball joints, level, the first hung from the world; the last has that mass.
inline Scene chain_of(int links, double last_mass) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  for (int i = 0; i < links; ++i) {
    scene.bodies.push_back(
        body("link" + std::to_string(i), i + 1 == links ? last_mass : 1, {0.1, 0.1, 0.1}, {i + 0.5, 0, 0}));
    scene.joints.push_back({.a = i == 0 ? kWorld : i - 1, .b = i, .type = BallJoint{Vec3(i, 0, 0)}});
  }
  return scene;
}

// Two runs, two steps each, the coarser first; nothing blew up.
inline Results jointed_results(const Scene& scene) {
  Results grid = sample_results();
  CaseResult& result = grid.cases.front();
  result.definition.scene = scene;
  const Cell good = result.cells[0];
  for (Cell& cell : result.cells) {
    const std::size_t run = cell.run;
    const StepSize dt = cell.dt;
    cell = good, cell.run = run, cell.dt = dt, cell.settings.clear(), cell.metrics.clear();
  }
  std::stable_sort(result.cells.begin(), result.cells.end(), [](const Cell& a, const Cell& b) {
    return a.run != b.run ? a.run < b.run : a.dt.seconds > b.dt.seconds;
  });
  return grid;
}

inline void set_metric(Results& grid, std::size_t run, const std::string& metric, std::pair<double, double> values,
                       const Instant& worst) {
  std::vector<Cell>& cells = grid.cases.front().cells;
  BOOST_REQUIRE(cells[2 * run].run == run);
  cells[2 * run].metrics[metric] = sample_metric(values.first, worst);
  cells[2 * run + 1].metrics[metric] = sample_metric(values.second, worst);
}

inline void set_gaps(Results& grid, std::size_t run, std::pair<double, double> gaps) {
  set_metric(grid, run, "joint_gap", gaps, {0.3, 0, "gap of the ball of 'world' and 'link0'", gaps.first, 0});
}

inline void set_setting(Results& grid, std::size_t run, const std::string& setting, const std::string& words) {
  for (Cell& cell : grid.cases.front().cells) {
    if (cell.run == run) cell.settings.emplace_back(setting, words);
  }
}

inline double coarse_over_fine(const Results& grid) {
  const std::vector<Cell>& cells = grid.cases.front().cells;
  return cells[0].dt.seconds / cells[1].dt.seconds;
}

}  // namespace rigor::test
