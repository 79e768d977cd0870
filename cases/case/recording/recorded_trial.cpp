#include "cases/case/recording/recorded_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/base/error.h"
#include "core/scene/toml/table_reader.h"

namespace rigor::inline cases {

RecordedBody& samples_of(RecordedTrial& trial, int body) {
  std::vector<RecordedBody>& bodies = trial.bodies;
  const auto known = std::find_if(bodies.begin(), bodies.end(), [&](const auto& one) { return one.body == body; });
  if (known != bodies.end()) return *known;
  bodies.emplace_back().body = body;
  return bodies.back();
}

void begin_at_zero(RecordedTrial& trial, const std::vector<std::string>& names, const std::string& path) {
  const std::string of = trial.name.empty() ? "the recording" : fmt::format("trial '{}'", shown(trial.name));
  double start = trial.bodies.front().times.front();
  for (const RecordedBody& body : trial.bodies) start = std::min(start, body.times.front());
  trial.duration = std::numeric_limits<double>::infinity();
  for (RecordedBody& body : trial.bodies) {
    const std::string& name = names[static_cast<std::size_t>(body.body)];
    if (body.times.size() < 2)
      throw InputError(fmt::format("{}: {} has one sample of '{}'; allowed: two or more of each body", path, of, name));
    if (body.times.front() != start)
      throw InputError(fmt::format("{}: {}: '{}' begins at {} s, and another body at {} s; allowed: one start", path,
                                   of, name, body.times.front(), start));
    for (double& time : body.times) time -= start;
    trial.duration = std::min(trial.duration, body.times.back());
  }
}

}  // namespace rigor::inline cases
