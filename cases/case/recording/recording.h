// Recorded motion: which bodies were measured, when, and how well. It is the truth of a case with truth.kind =
// "recording".
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math.h"
#include "core/scene/scene.h"

namespace rigor::inline cases {

// The samples of one body. A part that was not measured is empty; each other one has a row for each time.
struct RecordedBody {
  int body = 0;               // index in the scene
  std::vector<double> times;  // s from the trial's start; they rise and may leave gaps
  std::vector<Vec3> positions, velocities, angular_velocities;
  std::vector<Quat> orientations;
};

struct RecordedTrial {
  std::string name;
  std::vector<RecordedBody> bodies;
  double duration = 0;  // s: the last sample of the body that was recorded shortest
};

struct MotionRecording {
  std::string path;                 // of the CSV or MCAP file
  double position_noise = 0;        // m: standard deviation along each axis; 0 if no position was measured
  double orientation_noise = 0;     // rad: standard deviation about each axis; 0 if no orientation was measured
  bool is_noise_estimated = false;  // one of the two, from the scatter of the samples
  double length = 0;                // m: errors in percent are percent of it; 0: the case gives none
  std::string group;                // the column that divides the file into trials; empty: one trial
  std::string synthetic;            // the engine that made the motion; empty for measured motion
  int start_fit = 0;                // samples that determine the start; 0: the first one is the start
  std::uint64_t content = 0;        // hash of the file
  double piece = 0;                 // s: trials were cut into pieces of this length; 0: they are whole
  std::vector<RecordedTrial> trials;

  double longest() const;  // s
};

// Gives the bodies of the scene the trial's state at t = 0: its first sample, or a fit of the first samples. Parts that
// were not measured keep the scene's values.
void start_from(const MotionRecording& recording, std::size_t trial, Scene& scene);

// The trials of a CSV file with the columns of `rigor trace`: time, body, px py pz, qw qx qy qz, vx vy vz, wx wy wz, in
// any order, among other columns. Throws InputError with file, line and column. Each vector is whole or absent.
std::vector<RecordedTrial> read_trials(const std::string& text, const std::string& path, const std::string& group,
                                       const Scene& scene);

// The one trial of an MCAP file, from the poses of its channel with Foxglove's FrameTransforms as JSON, in the frame
// "world". It has no velocities. Throws InputError with file and byte.
std::vector<RecordedTrial> read_mcap_trials(std::string_view file, const std::string& path, const std::string& group,
                                            const Scene& scene);

}  // namespace rigor::inline cases
