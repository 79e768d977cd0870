// A sweep: cases × runs × the values of several keys, each cell with its row in a table. What shares a scene is one
// variant. A job is a few neighbouring rows of a variant: its process makes their truth and forks their cells. Jobs
// follow from the sweep alone, so that whoever has planned it can do any of them, and go on from any other's journal.
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

namespace rigor {

inline constexpr double kMostCells = 1e6;     // of a sweep
inline constexpr std::size_t kRowsOfJob = 8;  // at most
inline constexpr std::size_t kFewJobs = 64;   // so many there are before any has two rows, for shards that are alike

struct SweepRow {
  std::size_t of_case = 0, run = 0;  // indices in Sweep
  StepSize dt{0, ""};
  std::vector<std::string> values;  // of each axis
  Status status = Status::crashed;
  std::string reason = "it did not run";
  std::string verdict;                      // "stable", ...; empty where there is none
  std::vector<double> metrics;              // of Sweep::metrics; not a number where there is none
  std::vector<std::string> held_to_itself;  // those whose truth the run's own code makes (truth/provenance.h)
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
  std::size_t jobs() const { return first_jobs_.back(); }
  std::size_t first_row_of(std::size_t job) const;       // among all
  std::vector<SweepRow> rows_of(std::size_t job) const;  // as planned
  Case definition_of(std::size_t job) const;             // throws InputError
  // With the varied options. Throws InputError for an option that the method does not have.
  RunName run_of(const SweepRow& row) const;
  // Of what its results depend on, the program apart.
  std::string plan() const;

 private:
  using Point = std::vector<std::string>;  // a value of each axis
  struct Place {
    std::size_t of_case, scene, first;  // of a job: the row of its variant that it begins with
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

// What a row has come to, as text and from it. The second throws std::exception for what is no answer of this row.
std::string answer_of(const SweepRow& row);
void apply_answer(SweepRow& row, const std::string& answer);

// Calls `on_row` for each row of the shard, in their order, as they come; what it takes does not grow with their
// number.
void run_sweep(const Sweep& sweep, const EngineTable& engines, const SweepOptions& options,
               const std::function<void(const SweepRow& row)>& on_row);

}  // namespace rigor
