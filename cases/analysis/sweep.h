// A sweep: cases × runs × the values of several keys, each cell with its row in a table. What shares a scene is one
// variant: its truth is made once, in a process of its own, which forks the variant's cells.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "adapters/engines.h"
#include "cases/analysis/sweep_axis.h"
#include "cases/case/vocabulary.h"
#include "cases/results/results.h"
#include "cases/runner/executor.h"

namespace rigor {

inline constexpr double kMostCells = 1e6;  // of a sweep

struct SweepRow {
  std::size_t of_case = 0, run = 0;  // indices in Sweep
  StepSize dt{0, ""};
  std::vector<std::string> values;  // of each axis
  Status status = Status::crashed;
  std::string reason = "it did not run";
  std::string verdict;          // "stable", ...; empty where there is none
  std::vector<double> metrics;  // of Sweep::metrics; not a number where there is none
};

struct SweepInput {
  std::vector<Case> cases;
  std::vector<RunName> runs;
  std::vector<SweepAxis> axes;
  std::vector<std::string> metrics;  // those asked for; empty: all that are not costly
  std::size_t samples = 0;           // 0: the full grid
  unsigned long seed = 0;
};

class Sweep {
 public:
  // Throws InputError for a key that is none, with a near match; a value that no scene, step or option can have; and
  // for more than kMostCells cells, with their number.
  Sweep(SweepInput input, const Vocabulary& vocabulary);

  const std::vector<Case>& cases() const { return input_.cases; }
  const std::vector<RunName>& runs() const { return input_.runs; }
  const std::vector<SweepAxis>& axes() const { return input_.axes; }
  const std::vector<std::string>& metrics() const { return metrics_; }
  bool is_sampled() const { return input_.samples > 0; }
  bool asks_for_metrics() const { return !input_.metrics.empty(); }
  std::size_t cells() const { return cells_; }

  // Rows come variant by variant: by case, then by what the scene is, then by run, then by options and step.
  std::size_t variants() const { return input_.cases.size() * scenes_; }
  std::vector<SweepRow> rows_of(std::size_t variant) const;  // as planned
  Case definition_of(std::size_t variant) const;             // throws InputError
  // With the varied options. Throws InputError for an option that the method does not have.
  RunName run_of(const SweepRow& row) const;
  // Of what its results depend on, the program apart.
  std::string plan() const;

 private:
  using Point = std::vector<std::string>;  // a value of each axis
  Point point_of(std::size_t scene, std::size_t rest) const;
  Case definition_at(std::size_t of_case, const Point& point) const;
  void check_options();
  void check_values() const;
  [[noreturn]] void refuse_key(const SweepAxis& axis) const;

  SweepInput input_;
  const Vocabulary& vocabulary_;
  std::vector<std::string> metrics_;
  std::vector<std::size_t> scene_axes_, run_axes_;  // indices of axes; the first make another scene, or run longer
  std::vector<Point> samples_;
  std::size_t scenes_ = 1, rest_ = 1, cells_ = 0;  // scenes of a case; points of each
  bool has_step_axis_ = false;
};

struct SweepOptions {
  int jobs = 1;
  double limit = 60;                   // s of CPU time for each truth and each cell
  std::string journal = {};            // the file; empty: it is not kept
  const Executor* executor = nullptr;  // of the variants; null: processes of this machine
};

// Calls `on_row` for each row, in their order, as they come; what it takes does not grow with their number.
void run_sweep(const Sweep& sweep, const EngineTable& engines, const SweepOptions& options,
               const std::function<void(const SweepRow& row)>& on_row);

}  // namespace rigor
