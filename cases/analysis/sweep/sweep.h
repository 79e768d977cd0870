// A sweep: cases × runs × the values of several keys. Each cell is a row of a table. Cells with the same scene form a
// variant. A job is a few neighbouring rows of one variant. Its process computes their truth and forks their cells. The
// jobs depend on the plan alone, so any process can do any job and continue any journal.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "adapters/engines.h"
#include "cases/analysis/sweep/sweep_axis.h"
#include "cases/case/vocabulary.h"
#include "cases/results/results.h"
#include "cases/runner/executor.h"
#include "cases/runner/shards/shard.h"

namespace rigor::inline analysis {

inline constexpr double kMostCells = 1e6;     // of a sweep
inline constexpr std::size_t kRowsOfJob = 8;  // at most
inline constexpr std::size_t kFewJobs = 64;   // a sweep has so many jobs before one gets two rows, for equal shards

struct SweepRow {
  std::size_t of_case = 0, run = 0;  // indices in Sweep
  StepSize dt{0, ""};
  std::vector<std::string> values;  // of each axis
  Status status = Status::crashed;
  std::string reason = "it did not run";
  std::string verdict;                      // "stable", ...; empty where there is none
  std::vector<double> metrics;              // of Sweep::metrics; NaN if there is none
  std::vector<std::string> held_to_itself;  // metrics whose truth comes from the run's own code (truth/provenance.h)
};

struct SweepInput {
  std::vector<Case> cases;
  std::vector<RunName> runs;
  std::vector<SweepAxis> axes;
  std::vector<std::string> metrics;  // the requested ones; empty: all that are not costly
  std::size_t samples = 0;           // 0: the full grid
  unsigned long seed = 0;
};

class Sweep {
 public:
  // Throws InputError for an unknown key, with a near match; for a value that no scene, step or option can have; and
  // for more than kMostCells cells, with their number.
  Sweep(SweepInput input, const Vocabulary& vocabulary);

  const std::vector<Case>& cases() const { return input_.cases; }
  const std::vector<RunName>& runs() const { return input_.runs; }
  const std::vector<SweepAxis>& axes() const { return input_.axes; }
  const std::vector<std::string>& metrics() const { return metrics_; }
  bool is_sampled() const { return input_.samples > 0; }
  bool asks_for_metrics() const { return !input_.metrics.empty(); }
  std::size_t cells() const { return cells_; }

  // Rows come variant by variant: by case, then by scene, then by run, then by options and step.
  std::size_t jobs() const { return first_jobs_.back(); }
  std::size_t first_row_of(std::size_t job) const;       // among all
  std::vector<SweepRow> rows_of(std::size_t job) const;  // as planned
  Case definition_of(std::size_t job) const;             // throws InputError
  Case definition_of(const SweepRow& row) const { return definition_at(row.of_case, row.values); }
  // The run with the varied options. Throws InputError for an option that the method does not have.
  RunName run_of(const SweepRow& row) const;
  // All that the results depend on, except the program.
  std::string plan() const;

 private:
  using Point = std::vector<std::string>;  // a value of each axis
  struct Place {
    std::size_t of_case, scene, first;  // of a job; `first` is its first row in the variant
  };
  Place place_of(std::size_t job) const;
  std::size_t steps_of(std::size_t of_case) const { return has_step_axis_ ? 1 : input_.cases[of_case].dt.size(); }
  std::size_t rows_of_variant(std::size_t of_case) const { return input_.runs.size() * rest_ * steps_of(of_case); }
  std::size_t jobs_of_variant(std::size_t of_case) const {
    return (rows_of_variant(of_case) + rows_of_job_ - 1) / rows_of_job_;
  }
  SweepRow row_at(const Place& place, std::size_t row) const;
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
  std::size_t rows_of_job_ = 1;
  bool has_step_axis_ = false;
  std::vector<std::size_t> first_jobs_, first_rows_;  // of each case, and behind the last
};

struct SweepOptions {
  int jobs = 1;
  double limit = 60;                   // s of CPU time for each truth and each cell
  std::string journal = {};            // the file, in a folder of its own; empty: it is not kept
  const Executor* executor = nullptr;  // null: processes of this machine
  Shard shard = {};                    // of the sweep's jobs
};

// The jobs of a shard: from the first to before the second. Stretches of about the same number of rows.
std::pair<std::size_t, std::size_t> jobs_of(const Sweep& sweep, const Shard& shard);

// A row's result as text, and the row from such a text. The second throws std::exception for an answer of another row.
std::string answer_of(const SweepRow& row);
void apply_answer(SweepRow& row, const std::string& answer);

// Calls `on_row` for each row of the shard in order. The memory that it takes does not grow with their number.
void run_sweep(const Sweep& sweep, const EngineTable& engines, const SweepOptions& options,
               const std::function<void(const SweepRow& row)>& on_row);

}  // namespace rigor::inline analysis
