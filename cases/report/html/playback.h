// What the page plays and plots of one run: its motion and the courses of its metrics, thinned to a budget of bytes.
// Full precision stays in the CSV files. The page reads it in page/src/playback_data.js; the layout is in playback.cpp.
#pragma once

#include <string>
#include <vector>

#include "cases/metrics/metric.h"
#include "cases/runner/results.h"

namespace rigor {

struct NamedCourse {
  std::string name;            // of the metric; or kEnergyChange
  std::vector<double> values;  // one a sample, may be shorter than the trajectory
};

// (E - E at the start) / the truth's largest kinetic energy, with its sign, as read.
inline constexpr const char* kEnergyChange = "energy_change";

// The names that a packed course's number stands for.
const std::vector<std::string>& course_names();

// Of one run, as text in base64, of about `budget` characters at most; "" where that is too few for anything. `truth`
// may be null; a run that nobody could tell from it in the picture keeps no motion of its own.
std::string packed_run(const JudgedRun& run, const std::vector<NamedCourse>& courses, double largest_kinetic_energy,
                       std::size_t budget);

// Likewise of the truth itself.
std::string packed_truth(const Scene& scene, const Truth& truth, double duration, double largest_kinetic_energy,
                         std::size_t budget);

// What a cell, or with no dt the truth, may use of the whole page's budget.
std::size_t playback_budget(const Results& grid, const CaseResult& result, const StepSize* dt);

}  // namespace rigor
