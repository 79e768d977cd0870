// Recordings for tests, made by an engine from known values, with seeded noise.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <random>
#include <string>

#include "cases/case/case_reader.h"
#include "cases/runner/simulate.h"
#include "tests/cases/vocabulary.h"
#include "tests/folder.h"

namespace rigor::test {

inline constexpr double kPositionNoise = 1e-4, kOrientationNoise = 1e-3;  // m, rad

// A block that slides on the ground; each trial with another speed.
inline std::string sliding_scene(double friction) {
  return fmt::format(R"(title = "A block slides"
source = "made by a test"
[scene]
gravity = [0, 0, -9.81]
[[scene.body]]
name = "block"
mass = 1
position = [0, 0, 0.05]
velocity = [1, 0, 0]
shape = {{ type = "box", size = [0.4, 0.4, 0.1] }}
[[scene.body]]
name = "ground"
shape = {{ type = "plane", normal = [0, 0, 1], offset = 0 }}
[scene.contact_default]
restitution = 0
friction = {}
[run]
duration = 0.2
dt = 0.005
)",
                     friction);
}

inline std::string recorded_case(double friction, const std::string& file) {
  return sliding_scene(friction) + fmt::format(R"([truth]
kind = "recording"
file = "{}"
group = "trial"
position_noise = {}
orientation_noise = {}
length = 0.4
)",
                                               file, kPositionNoise, kOrientationNoise);
}

// Normal numbers from a seed, the same with every library.
class SeededNoise {
 public:
  explicit SeededNoise(unsigned long seed) : random_(seed) {}
  double draw() { return std::sqrt(-2 * std::log(1 - uniform())) * std::cos(2 * M_PI * uniform()); }
  double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  Vec3 vector(double deviation) {
    const double x = draw(), y = draw(), z = draw();
    return deviation * Vec3(x, y, z);
  }

 private:
  std::mt19937_64 random_;
};

// Trials of a block that slides with this friction, as the named run moves it. The start has no noise.
inline std::string sliding_recording(double friction, int trials, unsigned long seed,
                                     const std::string& run = "core:velocity-verlet") {
  const Case definition = read_case_text(sliding_scene(friction), "made.toml", "made", words());
  const RunName name = parse_run_name(run, words().engines);
  SeededNoise noise(seed);
  std::string text = "trial,time,body,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n";
  for (int k = 0; k < trials; ++k) {
    Scene scene = definition.scene;
    scene.bodies[0].velocity = {0.8 + 0.4 * noise.uniform(), 0.2 * noise.uniform(), 0};
    const Simulation made = simulate(find_engine(engines(), name.engine), name.settings, scene, 0.005, 0.2, {});
    for (std::size_t n = 0; n < made.trajectory.samples.size(); ++n) {
      BodyState body = made.trajectory.samples[n].bodies.columns().body(0);
      if (n > 0) {
        body.position += noise.vector(kPositionNoise);
        body.orientation = (rotation_by(noise.vector(kOrientationNoise)) * body.orientation).normalized();
      }
      const auto &p = body.position, &v = body.velocity, &w = body.angular_velocity;
      const Quat& q = body.orientation;
      text += fmt::format(
          "t{},{:.9f},block,{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},"
          "{:.17g},{:.17g},{:.17g},{:.17g}\n",
          k, made.trajectory.samples[n].time, p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), v.x(), v.y(), v.z(),
          w.x(), w.y(), w.z());
    }
  }
  return text;
}

}  // namespace rigor::test
