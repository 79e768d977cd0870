// Regressions: values that were measured, kept to guard against change. They are no truths. Each engine's stand beside
// its adapter, in adapters/<name>/regression.jsonl, one JSON object a line and one line a cell:
//   {"case": "contact/cradle", "run": "bullet", "dt": "1/30", "creep": 0.0117, "penetration": 0.0042}
// `rigor baseline --regression <name> out/results.json` writes the file again; reviewers check its difference.
#pragma once

#include <compare>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cases/case/case.h"
#include "core/engine/run_name.h"

namespace rigor::inline gates {

inline constexpr const char* kRegressionFile = "regression.jsonl";

// The values recorded, by case, run, step and metric. A run is known by its engine, method, options and track.
class RecordedValues {
 public:
  std::optional<double> find(const std::string& case_id, const RunName& run, double dt,
                             const std::string& metric) const;
  // False if there is one already.
  bool add(const std::string& case_id, const RunName& run, double dt, const std::string& metric, double value);

 private:
  struct Key {
    std::string case_id, engine, method;
    std::map<std::string, std::string> options;
    bool is_stock;
    std::string dt, metric;  // dt to ten digits
    auto operator<=>(const Key&) const = default;
  };
  static Key key_of(const std::string& case_id, const RunName& run, double dt, const std::string& metric);
  std::map<Key, double> values_;
};

// Reads every regression.jsonl in a folder of `adapters_dir`. Throws InputError, "file:line:column: ...", for a line of
// another form, an unknown name, or a duplicate value.
RecordedValues read_recorded_values(const std::string& adapters_dir, const std::vector<EngineInfo>& engines);

// The file of one engine: the values that a results.json has for its regressions. `left_out` counts those without a
// value, because the run produced no result. Throws InputError for a file that is no results.json or has no values of
// that engine.
struct RegressionText {
  std::string text;
  int left_out = 0;
};
RegressionText regression_text(const std::string& results_path, const std::string& engine);

// Compares a value with the recorded one: it must lie within the factor of it in both directions, plus 1e-9 for
// rounding. Returns the reason of a failure, or "".
std::string change_from(double recorded, double value, double factor);

}  // namespace rigor::inline gates
