// Reads a recording from an MCAP file: the poses of Foxglove's FrameTransforms, as `rigor trace --format mcap` writes
// them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "cases/case/recording/mcap_records.h"
#include "cases/case/recording/recorded_trial.h"
#include "cases/case/recording/recording.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/near_match.h"
#include "core/scene/toml/table_reader.h"

namespace rigor::inline cases {
namespace {

constexpr const char* kTransforms = "foxglove.FrameTransforms";
constexpr const char* kTransformsTopic = "/tf";
constexpr const char* kWorldFrame = "world";

class McapRecording {
 public:
  McapRecording(const std::string& path, const Scene& scene) : path_(path) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      names_.push_back(scene.bodies[i].name);
      bodies_.emplace(scene.bodies[i].name, static_cast<int>(i));
    }
  }

  std::vector<RecordedTrial> read(std::string_view file) {
    read_mcap(file, path_,
              {[this](const McapChannel& channel) { meet(channel); },
               [this](const McapMessage& message) {
                 if (message.topic == topic_) add(message);
               }});
    if (topic_.empty())
      throw InputError(fmt::format("{}: no channel has {} as JSON; it has: {}", path_, kTransforms,
                                   channels_.empty() ? "no channel" : shown(listed(channels_), 400)));
    if (trial_.bodies.empty())
      throw InputError(fmt::format("{}: the channel '{}' has no transform; allowed: two or more of each body", path_,
                                   shown(topic_)));
    begin_at_zero(trial_, names_, path_);
    return {std::move(trial_)};
  }

 private:
  // The usual topic counts, if several channels have transforms. Anything that came from another one before is dropped.
  void meet(const McapChannel& channel) {
    channels_.push_back(fmt::format("{} ({}, {})", channel.topic, channel.schema, channel.encoding));
    if (channel.schema != kTransforms || channel.encoding != "json") return;
    if (!topic_.empty() && topic_ != channel.topic && topic_ != kTransformsTopic && channel.topic != kTransformsTopic)
      throw InputError(fmt::format("{}: both '{}' and '{}' have transforms; allowed: one such channel, or '{}'", path_,
                                   shown(topic_), shown(channel.topic), kTransformsTopic));
    if (topic_ == channel.topic || topic_ == kTransformsTopic) return;
    topic_ = channel.topic, trial_ = {};
  }

  void add(const McapMessage& message) {
    place_ = message.place;
    const Json json = parse_json_or_discard(message.data);
    if (json.is_discarded()) refuse("the message is no JSON");
    const Json* transforms = json.is_object() && json.contains("transforms") ? &json.at("transforms") : nullptr;
    if (!transforms || !transforms->is_array()) refuse("the message has no list 'transforms'");
    for (const Json& transform : *transforms) add(transform, message.time);
  }

  void add(const Json& transform, std::uint64_t logged) {
    const std::string name = text(transform, "child_frame_id"), parent = text(transform, "parent_frame_id");
    const auto body = bodies_.find(name);
    if (body == bodies_.end())
      refuse(fmt::format("the scene has no body '{}'{}; it has: {}", shown(name), did_you_mean(name, names_),
                         shown(listed(names_), 400)));
    if (parent != kWorldFrame)
      refuse(fmt::format("'{}' is placed in the frame '{}'; allowed: '{}'", shown(name), shown(parent), kWorldFrame));
    RecordedBody& samples = samples_of(trial_, body->second);
    const double time = time_of(transform, logged);
    if (!samples.times.empty() && !(time > samples.times.back()))
      refuse(fmt::format("found the time {} s of '{}' after {} s; allowed: times that rise", time, shown(name),
                         samples.times.back()));
    const Json &place = part(transform, "translation"), &turn = part(transform, "rotation");
    const Quat q(number(turn, "w"), number(turn, "x"), number(turn, "y"), number(turn, "z"));
    if (std::abs(q.norm() - 1) > kUnitLength)
      refuse(fmt::format("found a quaternion of the length {:.4g}; allowed: a unit quaternion", q.norm()));
    samples.times.push_back(time);
    samples.positions.emplace_back(number(place, "x"), number(place, "y"), number(place, "z"));
    samples.orientations.push_back(q.normalized());
  }

  // s; without a stamp of its own a transform has the time at which its message was logged.
  double time_of(const Json& transform, std::uint64_t logged) const {
    if (!transform.contains("timestamp")) return static_cast<double>(logged) * 1e-9;
    const Json& stamp = part(transform, "timestamp");
    return number(stamp, "sec") + number(stamp, "nsec") * 1e-9;
  }

  const Json& part(const Json& of, const char* key) const {
    if (!of.is_object() || !of.contains(key) || !of.at(key).is_object())
      refuse(fmt::format("a transform has no '{}'; allowed: those of {}", key, kTransforms));
    return of.at(key);
  }
  std::string text(const Json& of, const char* key) const {
    if (!of.is_object() || !of.contains(key) || !of.at(key).is_string())
      refuse(fmt::format("a transform has no text '{}'; allowed: those of {}", key, kTransforms));
    return of.at(key).get<std::string>();
  }
  double number(const Json& of, const char* key) const {
    const double value = of.contains(key) && of.at(key).is_number() ? of.at(key).get<double>() : NAN;
    if (!std::isfinite(value)) refuse(fmt::format("'{}' is no finite number", key));
    return value;
  }

  [[noreturn]] void refuse(const std::string& fault) const {
    throw InputError(fmt::format("{}: byte {}: {}", path_, place_, fault));
  }

  const std::string& path_;
  std::vector<std::string> names_;
  std::map<std::string, int> bodies_;
  std::vector<std::string> channels_;  // as shown
  std::string topic_;
  std::size_t place_ = 0;
  RecordedTrial trial_;
};

}  // namespace

std::vector<RecordedTrial> read_mcap_trials(std::string_view file, const std::string& path, const std::string& group,
                                            const Scene& scene) {
  if (!group.empty())
    throw InputError(
        fmt::format("{}: truth.group names the column '{}', and an MCAP file has no columns; allowed: no "
                    "truth.group, since the file is one trial",
                    path, shown(group)));
  return McapRecording(path, scene).read(file);
}

}  // namespace rigor::inline cases
