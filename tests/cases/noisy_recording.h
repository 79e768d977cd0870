// Recordings with noise in every sample, the first one included, as of a real camera.
#pragma once

#include "tests/cases/recorded_case.h"

namespace rigor::test {

// Trials of body 0 of the case, as the named run moves it. The velocities are wrong by some percent, as those of a
// tracker are; only the fit's first guess comes from them. `spread`: by how much the start's speed differs by trial,
// m/s.
inline std::string noisy_recording(const std::string& text, int trials, unsigned long seed, double spread = 0,
                                   const std::string& run = "core:velocity-verlet") {
  const Case definition = read_case_text(text, "made.toml", "made", words());
  const RunName name = parse_run_name(run, words().engines);
  SeededNoise noise(seed);
  std::string rows = "trial,time,body,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n";
  for (int k = 0; k < trials; ++k) {
    Scene scene = definition.scene;
    scene.bodies[0].velocity += spread * Vec3(noise.uniform(), noise.uniform(), 0);
    const Simulation made = simulate(find_engine(engines(), name.engine), name.settings, scene,
                                     definition.dt.front().seconds, definition.duration, {});
    for (const Sample& sample : made.trajectory.samples) {
      const BodyState body = sample.bodies.columns().body(0);
      const Vec3 p = body.position + noise.vector(kPositionNoise);
      const Quat q = (rotation_by(noise.vector(kOrientationNoise)) * body.orientation).normalized();
      const Vec3 v = body.velocity + noise.vector(0.005), w = body.angular_velocity + noise.vector(0.01);
      rows += fmt::format(
          "t{},{:.9f},{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},"
          "{:.17g},{:.17g}\n",
          k, sample.time, scene.bodies[0].name, p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), v.x(), v.y(), v.z(),
          w.x(), w.y(), w.z());
    }
  }
  return rows;
}

// [truth] of such a recording; without `has_noise` its noise is estimated.
inline std::string noisy_truth(const std::string& file, bool has_noise = true) {
  std::string text = fmt::format("[truth]\nkind = \"recording\"\nfile = \"{}\"\ngroup = \"trial\"\n", file);
  if (has_noise)
    text += fmt::format("position_noise = {}\norientation_noise = {}\n", kPositionNoise, kOrientationNoise);
  return text;
}

}  // namespace rigor::test
