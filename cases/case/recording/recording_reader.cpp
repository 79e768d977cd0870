#include "cases/case/recording/recording_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "cases/case/recording/mcap_records.h"
#include "cases/case/recording/noise.h"
#include "cases/case/recording/pieces.h"
#include "core/base/content_hash.h"
#include "core/base/error.h"
#include "core/scene/shapes/mesh_file.h"
#include "core/scene/toml/file_reader.h"
#include "core/scene/toml/scene_reader.h"

namespace rigor::inline cases {
namespace {

namespace fs = std::filesystem;

// The file beside the case file, else the one in the folder RIGOR_DATA; empty if it is in neither.
std::string found_file(const TomlValue& file) {
  const std::string name = file.text();
  std::error_code error;
  if (fs::path(name).is_absolute()) return fs::exists(name, error) ? name : "";
  try {
    const std::string beside = path_beside(file.path(), name);
    if (fs::exists(beside, error)) return beside;
  } catch (const InputError& fault) {
    file.refuse(shown(fault.what(), 400));
  }
  const char* folder = std::getenv("RIGOR_DATA");
  if (folder == nullptr || *folder == '\0') return "";
  const std::string there = (fs::path(folder) / name).string();
  return fs::exists(there, error) ? there : "";
}

struct ParsedFile {
  std::uint64_t content = 0;
  std::vector<RecordedTrial> trials;
};

// Sweeps and fits ask for the same file again and again.
std::shared_ptr<const ParsedFile> parsed_file(const std::string& path, const std::string& group, const Scene& scene) {
  constexpr std::size_t kMostKept = 16;
  static std::map<std::string, std::shared_ptr<const ParsedFile>> kept;
  std::error_code error;
  std::string key = fmt::format("{}\n{}\n{} {}", path, group, fs::file_size(path, error),
                                fs::last_write_time(path, error).time_since_epoch().count());
  for (const Body& body : scene.bodies) key += fmt::format("\n{} {}", body.name, body.fixed);
  if (const auto found = kept.find(key); found != kept.end()) return found->second;
  const std::string text = read_text_file(path);
  const bool is_mcap = path.ends_with(".mcap") || text.starts_with(mcap::kMagic);
  const auto parsed = std::make_shared<const ParsedFile>(
      ParsedFile{content_hash(text),
                 is_mcap ? read_mcap_trials(text, path, group, scene) : read_trials(text, path, group, scene)});
  if (kept.size() >= kMostKept) kept.clear();
  return kept[key] = parsed;
}

int read_start_fit(const TomlValue& value) {
  // Of three samples a parabola has no residual. More than 10000 are no start any more.
  constexpr int kFewest = 4, kMost = 10000;
  const double count = value.number();
  if (count != std::floor(count) || count < kFewest || count > kMost)
    value.refuse(fmt::format("found {}; allowed: a whole number from {} to {}", count, kFewest, kMost));
  return static_cast<int>(count);
}

// A stated value, else the scatter of the samples.
void read_noise(const TableReader& truth, MotionRecording& recording) {
  const auto position = truth.find("position_noise"), orientation = truth.find("orientation_noise");
  if (position) recording.position_noise = position->positive();
  if (orientation) recording.orientation_noise = orientation->positive();
  if (position && orientation) return;
  const EstimatedNoise estimated = estimated_noise(recording.trials);
  const auto is_measured = [&](const auto part) { return !(recording.trials.front().bodies.front().*part).empty(); };
  const auto estimate = [&](bool is_wanted, const std::optional<double>& value, const char* key, double& noise) {
    if (!is_wanted) return;
    if (!value)
      truth.at("file").refuse(
          fmt::format("{} shows no scatter over nine samples in a row, so its noise is not known; allowed: truth.{}",
                      recording.path, key));
    noise = *value, recording.is_noise_estimated = true;
  };
  estimate(!position && is_measured(&RecordedBody::positions), estimated.position, "position_noise",
           recording.position_noise);
  estimate(!orientation && is_measured(&RecordedBody::orientations), estimated.orientation, "orientation_noise",
           recording.orientation_noise);
}

void cut(const TableReader& truth, MotionRecording& recording) {
  const auto piece = truth.find("piece");
  if (!piece) return;
  recording.piece = piece->positive();
  try {
    recording.trials = pieces_of(recording.trials, recording.piece);
  } catch (const InputError& fault) {
    piece->refuse(fault.what());
  }
}

// The start needs the rate of each part that was measured.
void check_start_is_known(const TableReader& truth, const MotionRecording& recording) {
  for (const RecordedTrial& trial : recording.trials) {
    for (const RecordedBody& body : trial.bodies) {
      const auto samples = static_cast<int>(body.times.size());
      if (recording.start_fit > samples)
        truth.at("start_fit")
            .refuse(fmt::format("found {}, and trial '{}' has {} samples; allowed: at most so many",
                                recording.start_fit, trial.name, samples));
      if (recording.start_fit > 0) continue;
      const bool has_rates = (body.positions.empty() || !body.velocities.empty()) &&
                             (body.orientations.empty() || !body.angular_velocities.empty());
      if (!has_rates)
        truth.at("file").refuse(fmt::format(
            "{} has no {}, so the start is not known; allowed: these columns of a CSV file, or truth.start_fit = N, "
            "which determines the start from N samples",
            recording.path, body.velocities.empty() ? "vx, vy, vz" : "wx, wy, wz"));
    }
  }
}

}  // namespace

const Keys& truth_keys() {
  static const Keys keys = {"kind",   "file",  "position_noise", "orientation_noise", "group",
                            "length", "piece", "start_fit",      "synthetic"};
  return keys;
}

namespace {

// Null if the file is missing.
std::shared_ptr<const MotionRecording> read(const TableReader& truth, const Case& of) {
  MotionRecording recording;
  if (const auto group = truth.find("group")) recording.group = group->text();
  if (const auto length = truth.find("length")) recording.length = length->positive();
  if (const auto count = truth.find("start_fit")) recording.start_fit = read_start_fit(*count);
  if (const auto engine = truth.find("synthetic")) recording.synthetic = engine->text();
  const TomlValue file = truth.at("file");
  recording.path = found_file(file);
  if (recording.path.empty()) return nullptr;
  const std::shared_ptr<const ParsedFile> parsed = parsed_file(recording.path, recording.group, of.scene);
  recording.content = parsed->content, recording.trials = parsed->trials;
  read_noise(truth, recording);
  cut(truth, recording);
  check_start_is_known(truth, recording);
  return std::make_shared<const MotionRecording>(std::move(recording));
}

}  // namespace

void read_recording(const TableReader& truth, Case& out) {
  out.path = truth.at("file").path();
  out.recording = read(truth, out);
  if (!out.recording) return;
  check_covers(*out.recording, out.duration, truth.at("file").label());
  start_from(*out.recording, 0, out.scene);
}

std::string missing_recording(const Case& definition) {
  if (definition.truth != "recording" || definition.recording) return "";
  return fmt::format(
      "its recording is neither beside the case file nor in the folder that RIGOR_DATA names; it is published here: {}",
      definition.source.empty() ? "the case file does not say where" : definition.source);
}

void check_covers(const MotionRecording& recording, double duration, const std::string& what) {
  constexpr double kRounding = 1e-6;  // of times written with seven digits
  if (recording.longest() >= duration * (1 - kRounding)) return;
  throw InputError(fmt::format("{}: {} ends after {:g} s, and the run after {:g} s; allowed: a run of at most {:g} s",
                               what, recording.path, recording.longest(), duration, recording.longest()));
}

}  // namespace rigor::inline cases
