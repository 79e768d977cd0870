// Trajectories as CSV: time, body and the thirteen columns of a body's state, one row per body and instant. Numbers
// have 17 significant digits, so that reading restores the same double. Names are quoted as RFC 4180 requires.
#pragma once

#include <string>

#include "cases/runner/recorder.h"
#include "core/engine/trajectory.h"
#include "core/scene/scene.h"

namespace rigor::inline report {

std::string csv_header();
std::string csv_field(const std::string& text);
void append_number(std::string& out, double value);  // as printf's %.17g

// The rows of one instant. `last_column` is appended to each: "" or ",<number>".
void append_csv_rows(std::string& out, const Scene& scene, double time, BodyColumns bodies,
                     const std::string& last_column = "");

// Writes the whole of it to `path`. Throws std::runtime_error if that fails.
void write_trajectory(const std::string& path, const Scene& scene, const Trajectory& trajectory);

// Each cell's, to the file that it names in a folder.
class TrajectoryRecorder : public Recorder {
 public:
  explicit TrajectoryRecorder(std::string folder) : folder_(std::move(folder)) {}
  std::string name() const override { return "trajectories"; }
  Recording of_truth(const Case&, const Truth&, const TruthFacts&) const override { return {}; }
  Recording of_run(const Case& definition, const Cell& cell, const JudgedRun& run, const std::vector<NamedSeries>&,
                   const TruthFacts&) const override;
  void discard(const Cell& cell) const override;
  bool still_has(const Cell& cell) const override;

 private:
  std::string folder_;
};

}  // namespace rigor::inline report
