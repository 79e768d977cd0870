#include "cases/analysis/fitting/fit_probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <set>

#include "cases/case/recording/recording_reader.h"
#include "cases/case/settled_velocities.h"
#include "cases/truth/recorded/recorded_motion.h"
#include "core/base/error.h"
#include "core/engine/engine_failure.h"

namespace rigor::inline analysis {
namespace {

SweepInput sweep_of(const FitInput& input) {
  SweepInput sweep;
  sweep.cases = input.cases, sweep.runs = {input.run}, sweep.axes = input.axes;
  sweep.samples = 1, sweep.seed = input.seed;
  return sweep;
}

// A message: which error, and the error.
struct Heard {
  std::size_t point, trial;
  TrialError error;
};

std::string packed(const Heard& heard) { return {reinterpret_cast<const char*>(&heard), sizeof heard}; }

bool unpack(const std::string& text, Heard& heard) {
  if (text.size() != sizeof heard) return false;
  std::memcpy(&heard, text.data(), sizeof heard);
  return true;
}

// A message: which run, how many residuals of positions and rotations, and these.
struct ResidualsHead {
  std::size_t run, positions, rotations;
  bool has_result;
};

std::string bytes_of(const std::vector<double>& values) {
  return {reinterpret_cast<const char*>(values.data()), sizeof(double) * values.size()};
}

std::string packed(std::size_t run, const TrialResiduals& one) {
  const ResidualsHead head{run, one.positions.size(), one.rotations.size(), one.has_result};
  return std::string(reinterpret_cast<const char*>(&head), sizeof head) + bytes_of(one.positions) +
         bytes_of(one.rotations);
}

void unpack(const std::string& text, std::vector<TrialResiduals>& all) {
  ResidualsHead head{};
  if (text.size() < sizeof head) return;
  std::memcpy(&head, text.data(), sizeof head);
  if (head.run >= all.size() || text.size() != sizeof head + sizeof(double) * (head.positions + head.rotations)) return;
  TrialResiduals& one = all[head.run];
  const char* from = text.data() + sizeof head;
  for (auto [values, count] : {std::pair(&one.positions, head.positions), {&one.rotations, head.rotations}}) {
    values->resize(count);
    if (count > 0) std::memcpy(values->data(), from, sizeof(double) * count);
    from += sizeof(double) * count;
  }
  one.has_result = head.has_result;
}

// The trials of one child: every `stride`-th from `first`, all of one point.
struct TrialShare {
  std::size_t point, first, stride;
};

// Into how many shares the runs of a point go, so that no child waits for long until the last has ended.
std::size_t shares_of(std::size_t runs, std::size_t points, int jobs) {
  constexpr std::size_t kForEachJob = 2;
  const std::size_t wanted = kForEachJob * static_cast<std::size_t>(std::max(1, jobs));
  return std::min(runs, (wanted + points - 1) / points);
}

}  // namespace

FitProbe::FitProbe(const FitInput& input, const EngineTable& engines, const Vocabulary& vocabulary)
    : input_(input), engines_(engines), sweep_(sweep_of(input), vocabulary) {
  for (const Case& definition : input.cases) {
    const std::string missing = missing_recording(definition);
    if (!missing.empty()) throw InputError(fmt::format("{}: {}", definition.id, missing));
    if (definition.truth == "none")
      throw InputError(
          fmt::format("{}: the case states no truth to fit to; allowed: any truth but \"none\"", definition.id));
    std::vector<std::shared_ptr<const Truth>>& truths = truths_.emplace_back();
    const auto recording = definition.recording;
    recordings_.push_back(recording);
    if (!recording) truths.push_back(truth_of(definition, definition.duration));
    for (std::size_t k = 0; recording && k < recording->trials.size(); ++k)
      truths.push_back(
          std::make_shared<const RecordedMotion>(recording, k, case_of_trial(definition, *recording, k).scene));
  }
  check_ends();
}

// Values between two that a case can have are possible, too.
void FitProbe::check_ends() const {
  for (const double end : {0.0, 1.0}) {
    const BoxPoint point(input_.axes.size(), end);
    const RunName run = run_at(point);
    for (std::size_t c = 0; c < input_.cases.size(); ++c) {
      const Case definition = definition_at(point, c);
      const std::string why =
          why_unsupported(engines_.info_of(run.engine), run.settings, definition.scene, definition.dt.front().seconds);
      if (!why.empty()) throw InputError(fmt::format("{}: {}: unsupported: {}", definition.id, run.text, why));
    }
  }
}

FitTrials FitProbe::all_trials() const {
  FitTrials trials;
  for (std::size_t c = 0; c < truths_.size(); ++c)
    for (std::size_t k = 0; k < truths_[c].size(); ++k) trials.push_back({c, k});
  return trials;
}

std::vector<std::string> FitProbe::values_at(const BoxPoint& point) const {
  std::vector<std::string> values;
  for (std::size_t i = 0; i < point.size(); ++i) values.push_back(value_at(sweep_.axes()[i], point[i]));
  return values;
}

SweepRow FitProbe::row_at(const BoxPoint& point, std::size_t of_case) const {
  SweepRow row;
  row.of_case = of_case, row.values = values_at(point);
  return row;
}

Case FitProbe::definition_at(const BoxPoint& point, std::size_t of_case) const {
  return sweep_.definition_of(row_at(point, of_case));
}

RunName FitProbe::run_at(const BoxPoint& point) const { return sweep_.run_of(row_at(point, 0)); }

std::vector<std::vector<TrialError>> FitProbe::errors(const std::vector<BoxPoint>& points, const FitTrials& trials) {
  std::vector<std::vector<TrialError>> errors(points.size(), std::vector<TrialError>(trials.size()));
  const std::size_t stride = shares_of(trials.size(), points.size(), input_.jobs);
  std::vector<Job> jobs;
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (std::size_t first = 0; first < stride; ++first) {
      const TrialShare share{p, first, stride};
      const auto work = [&, share](const Channel& channel) {
        const RunName run = run_at(points[share.point]);
        const Engine& engine = engines_.find(run.engine);
        std::vector<Case> definitions;
        for (std::size_t c = 0; c < input_.cases.size(); ++c)
          definitions.push_back(definition_at(points[share.point], c));
        for (std::size_t t = share.first; t < trials.size(); t += share.stride) {
          const auto [c, k] = trials[t];
          const Case one = recordings_[c] ? case_of_trial(definitions[c], *recordings_[c], k) : definitions[c];
          Heard heard{share.point, t, {}};
          try {
            heard.error = trial_error(one, *truths_[c][k], engine, run.settings, one.dt.front().seconds);
          } catch (const EngineFailure&) {
            // counts as a run without result
          }
          channel.send(packed(heard));
        }
        engines_.rest();
      };
      jobs.push_back({work, input_.limit});
    }
  }
  std::string refused;
  run_jobs(
      jobs, input_.jobs,
      [&](std::size_t, const std::string& message) {
        Heard heard{};
        if (unpack(message, heard) && heard.point < errors.size() && heard.trial < trials.size())
          errors[heard.point][heard.trial] = heard.error;
      },
      [&](std::size_t, const JobEnd& end) {
        if (end.how == Ending::refused) refused = end.text;
      });
  if (!refused.empty()) throw InputError(refused);
  points_ += points.size();
  if (input_.on_points) input_.on_points(points_);
  return errors;
}

void FitProbe::send_residuals(const std::vector<StartedTrial>& runs, std::size_t first, std::size_t stride,
                              const Channel& channel) const {
  std::map<std::pair<BoxPoint, std::size_t>, Case> definitions;  // most runs of a batch differ by their start alone
  for (std::size_t n = first; n < runs.size(); n += stride) {
    const auto [c, k] = runs[n].trial;
    const auto key = std::pair(runs[n].at, c);
    if (!definitions.contains(key)) definitions.emplace(key, definition_at(runs[n].at, c));
    Case one = case_of_trial(definitions.at(key), *recordings_[c], k);
    const std::vector<RecordedBody>& bodies = recordings_[c]->trials[k].bodies;
    TrialResiduals residuals;
    try {
      for (std::size_t b = 0; b < bodies.size(); ++b)
        move_start(one.scene.bodies[static_cast<std::size_t>(bodies[b].body)], runs[n].shifts[b]);
      settle_velocities(one.scene);
      const RunName run = run_at(runs[n].at);
      residuals = trial_residuals(one, *as_recording(truths_[c][k].get()), engines_.find(run.engine), run.settings,
                                  one.dt.front().seconds);
    } catch (const EngineFailure&) {
      // counts as a run without result
    }
    channel.send(packed(n, residuals));
  }
  engines_.rest();
}

std::vector<TrialResiduals> FitProbe::residuals(const std::vector<StartedTrial>& runs) {
  std::vector<TrialResiduals> all(runs.size());
  const std::size_t stride = shares_of(runs.size(), 1, input_.jobs);
  std::vector<Job> jobs;
  for (std::size_t first = 0; first < stride; ++first)
    jobs.push_back(
        {[&, first](const Channel& channel) { send_residuals(runs, first, stride, channel); }, input_.limit});
  std::string refused;
  run_jobs(
      jobs, input_.jobs, [&](std::size_t, const std::string& message) { unpack(message, all); },
      [&](std::size_t, const JobEnd& end) {
        if (end.how == Ending::refused) refused = end.text;
      });
  if (!refused.empty()) throw InputError(refused);
  std::set<BoxPoint> points;
  for (const StartedTrial& run : runs) points.insert(run.at);
  points_ += points.size();
  if (input_.on_points) input_.on_points(points_);
  return all;
}

}  // namespace rigor::inline analysis
