#include "cases/analysis/sweep/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "cases/case/case_reader.h"
#include "cases/case/recording/recording_reader.h"
#include "cases/metrics/metric.h"
#include "cases/runner/grid.h"
#include "core/base/error.h"
#include "core/base/near_match.h"
#include "core/scene/toml/writing/value_writer.h"

namespace rigor::inline analysis {
namespace {

using Kind = SweepAxis::Kind;

bool changes_scene(const SweepAxis& axis) { return axis.kind == Kind::scene || axis.kind == Kind::length; }

const OptionInfo* find_option(const MethodInfo& method, const std::string& name) {
  for (const OptionInfo& option : method.options) {
    if (option.name == name) return &option;
  }
  return nullptr;
}

const MethodInfo& method_of(const RunName& run, const std::vector<EngineInfo>& engines) {
  for (const EngineInfo& engine : engines) {
    if (engine.name == run.engine) return method_of(engine, run.settings);
  }
  throw std::logic_error("a run of no engine");
}

// "ode,erp=0.2@stock": an option more.
std::string with_varied_option(std::string run, const std::string& name, const std::string& value) {
  return run.insert(std::min(run.find('@'), run.size()), fmt::format(",{}={}", name, value));
}

std::vector<std::string> metrics_of(const std::vector<std::string>& asked_for) {
  std::vector<std::string> all, cheap;
  for (const MetricRow& row : metrics()) {
    all.push_back(row.name);
    if (!row.is_costly && row.name != "cost") cheap.push_back(row.name);
  }
  for (const std::string& name : asked_for) {
    if (std::find(all.begin(), all.end(), name) == all.end())
      throw InputError(fmt::format("--metric: there is no metric '{}' of one run{}; there is: {}", name,
                                   did_you_mean(name, all), listed(all)));
  }
  return asked_for.empty() ? cheap : asked_for;
}

void check_count(double cells) {
  if (cells <= kMostCells) return;
  throw InputError(
      fmt::format("the sweep would be {:.0f} cells; allowed: at most {:.0f}. Give fewer values, or draw "
                  "some of them by --sample N",
                  cells, kMostCells));
}

}  // namespace

Sweep::Sweep(SweepInput input, const Vocabulary& vocabulary) : input_(std::move(input)), vocabulary_(vocabulary) {
  metrics_ = metrics_of(input_.metrics);
  for (std::size_t i = 0; i < input_.axes.size(); ++i) {
    (changes_scene(input_.axes[i]) ? scene_axes_ : run_axes_).push_back(i);
    has_step_axis_ |= input_.axes[i].kind == Kind::step;
    for (std::size_t j = 0; j < i; ++j) {
      if (input_.axes[j].key == input_.axes[i].key)
        throw InputError(fmt::format("--vary: '{}' is varied twice", input_.axes[i].key));
    }
  }
  check_options();
  const auto points_of = [&](const std::vector<std::size_t>& axes) {
    double points = 1;
    for (const std::size_t i : axes) points *= static_cast<double>(input_.axes[i].values.size());
    return points;
  };
  const auto samples = static_cast<double>(input_.samples);
  const double scenes = !is_sampled() ? points_of(scene_axes_) : scene_axes_.empty() ? 1 : samples;
  const double rest = !is_sampled() ? points_of(run_axes_) : scene_axes_.empty() ? samples : 1;
  double steps = 0;
  for (const Case& definition : input_.cases) steps += has_step_axis_ ? 1 : static_cast<double>(definition.dt.size());
  const double cells = scenes * rest * steps * static_cast<double>(input_.runs.size());
  check_count(cells);
  scenes_ = static_cast<std::size_t>(scenes), rest_ = static_cast<std::size_t>(rest);
  cells_ = static_cast<std::size_t>(cells);
  rows_of_job_ = std::clamp<std::size_t>(cells_ / kFewJobs, 1, kRowsOfJob);
  first_jobs_ = first_rows_ = {0};
  for (std::size_t c = 0; c < input_.cases.size(); ++c) {
    first_jobs_.push_back(first_jobs_.back() + scenes_ * jobs_of_variant(c));
    first_rows_.push_back(first_rows_.back() + scenes_ * rows_of_variant(c));
  }
  for (const auto& shares : is_sampled() ? sample_points(input_.samples, input_.axes.size(), input_.seed)
                                         : std::vector<std::vector<double>>()) {
    Point point;
    for (std::size_t i = 0; i < shares.size(); ++i) point.push_back(value_at(input_.axes[i], shares[i]));
    samples_.push_back(std::move(point));
  }
  check_values();
}

void Sweep::refuse_key(const SweepAxis& axis) const {
  std::vector<std::string> known = {"dt", "duration", "scene"};
  for (const RunName& run : input_.runs) {
    for (const OptionInfo& option : method_of(run, vocabulary_.engines).options) {
      if (std::find(known.begin(), known.end(), option.name) == known.end()) known.push_back(option.name);
    }
  }
  throw InputError(
      fmt::format("--vary: there is no key '{}'{}; there is: {}, and any path below scene, as "
                  "scene.spring[0].stiffness",
                  axis.key, did_you_mean(axis.key, known), listed(known)));
}

void Sweep::check_options() {
  for (SweepAxis& axis : input_.axes) {
    if (axis.kind != Kind::option) continue;
    bool is_known = false;
    for (const RunName& run : input_.runs) {
      const OptionInfo* option = find_option(method_of(run, vocabulary_.engines), axis.key);
      if (option && option->whole) make_whole(axis);
      is_known |= option != nullptr;
    }
    if (!is_known) refuse_key(axis);
    for (const RunName& run : input_.runs) {
      if (!find_option(method_of(run, vocabulary_.engines), axis.key)) continue;
      for (const std::string& value : axis.values)
        parse_run_name(with_varied_option(run.text, axis.key, value), vocabulary_.engines);
    }
  }
}

// Checks each value in one of the sweep's own scenes before anything runs. A value may still not combine with others.
// Such cells become `invalid`.
void Sweep::check_values() const {
  constexpr std::size_t kMost = 1000;  // of samples, and about as many of an axis: evenly, with its first and its last
  for (std::size_t c = 0; c < input_.cases.size(); ++c) {
    for (std::size_t i = 0; i < std::min(samples_.size(), kMost); ++i) definition_at(c, samples_[i]);
    if (is_sampled()) continue;
    Point first;
    for (const SweepAxis& axis : input_.axes) first.push_back(axis.values.front());
    for (std::size_t i = 0; i < input_.axes.size(); ++i) {
      if (input_.axes[i].kind == Kind::option) continue;
      const auto& values = input_.axes[i].values;
      Point point = first;
      for (std::size_t v = 0; v < values.size(); v += 1 + values.size() / kMost) {
        point[i] = values[v];
        definition_at(c, point);
      }
      point[i] = values.back();
      definition_at(c, point);
    }
    if (input_.axes.empty()) definition_at(c, first);
  }
}

Sweep::Point Sweep::point_of(std::size_t scene, std::size_t rest) const {
  if (is_sampled()) return samples_[scene_axes_.empty() ? rest : scene];
  Point point(input_.axes.size());
  const auto take = [&](const std::vector<std::size_t>& axes, std::size_t number) {
    for (auto axis = axes.rbegin(); axis != axes.rend(); ++axis) {
      const auto& values = input_.axes[*axis].values;
      point[*axis] = values[number % values.size()];
      number /= values.size();
    }
  };
  take(scene_axes_, scene), take(run_axes_, rest);
  return point;
}

Case Sweep::definition_at(std::size_t of_case, const Point& point) const {
  const Case& base = input_.cases[of_case];
  std::string text = base.text, set;
  Overrides overrides{base.dt, base.duration};
  try {
    for (std::size_t i = 0; i < point.size(); ++i) {
      const SweepAxis& axis = input_.axes[i];
      if (axis.kind == Kind::option) continue;
      set += fmt::format("{}{}={}", set.empty() ? "" : ", ", axis.key, point[i]);
      if (axis.kind == Kind::scene) text = with_value(text, axis.key, point[i]);
      if (axis.kind == Kind::length) overrides.duration = parse_step_size(point[i], "duration").seconds;
      if (axis.kind == Kind::step) overrides.dt = {parse_step_size(point[i], "dt")};
    }
    Case definition = read_case_text(text, base.path.empty() ? base.id : base.path, base.id, vocabulary_);
    definition.gates.clear();  // they are the scene's as it was written
    override_run(definition, overrides);
    return definition;
  } catch (const InputError& error) {
    throw InputError(fmt::format("--vary {}: {}", set, error.what()));
  }
}

Sweep::Place Sweep::place_of(std::size_t job) const {
  const auto behind = std::upper_bound(first_jobs_.begin(), first_jobs_.end(), job);
  const auto of_case = static_cast<std::size_t>(behind - first_jobs_.begin()) - 1;
  const std::size_t within = job - first_jobs_[of_case], each = jobs_of_variant(of_case);
  return {of_case, within / each, rows_of_job_ * (within % each)};
}

Case Sweep::definition_of(std::size_t job) const {
  const Place place = place_of(job);
  return definition_at(place.of_case, point_of(place.scene, 0));
}

std::size_t Sweep::first_row_of(std::size_t job) const {
  if (job == jobs()) return cells_;
  const Place place = place_of(job);
  return first_rows_[place.of_case] + place.scene * rows_of_variant(place.of_case) + place.first;
}

SweepRow Sweep::row_at(const Place& place, std::size_t number) const {
  const std::size_t steps = steps_of(place.of_case);
  SweepRow row;
  row.of_case = place.of_case, row.run = number / (steps * rest_);
  row.metrics.assign(metrics_.size(), std::numeric_limits<double>::quiet_NaN());
  row.values = point_of(place.scene, number / steps % rest_);
  if (!has_step_axis_) row.dt = input_.cases[place.of_case].dt[number % steps];
  for (std::size_t i = 0; i < row.values.size(); ++i) {
    if (input_.axes[i].kind == Kind::step) row.dt = parse_step_size(row.values[i], "dt");
  }
  return row;
}

std::vector<SweepRow> Sweep::rows_of(std::size_t job) const {
  const Place place = place_of(job);
  std::vector<SweepRow> rows;
  for (std::size_t i = place.first; i < std::min(place.first + rows_of_job_, rows_of_variant(place.of_case)); ++i)
    rows.push_back(row_at(place, i));
  return rows;
}

RunName Sweep::run_of(const SweepRow& row) const {
  std::string text = input_.runs[row.run].text;
  for (std::size_t i = 0; i < input_.axes.size(); ++i) {
    if (input_.axes[i].kind == Kind::option) text = with_varied_option(text, input_.axes[i].key, row.values[i]);
  }
  return parse_run_name(text, vocabulary_.engines);
}

std::string Sweep::plan() const {
  std::string plan = fmt::format("{} {}\n", input_.samples, input_.seed);
  for (const Case& definition : input_.cases) {
    plan += fmt::format("{}\n{}\n{:.17g}\n", definition.id, definition.text, definition.duration);
    for (const StepSize& dt : definition.dt) plan += dt.text + "\n";
    if (const auto recording = definition.recording) plan += fmt::format("{:016x}\n", recording->content);
  }
  for (const RunName& run : input_.runs) plan += run.text + "\n";
  for (const SweepAxis& axis : input_.axes)
    plan += fmt::format("{}={} {} {}\n", axis.key, fmt::join(axis.values, ","), axis.is_range, axis.is_log);
  return plan + fmt::format("{}\n", fmt::join(metrics_, " "));
}

}  // namespace rigor::inline analysis
