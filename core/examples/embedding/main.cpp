// A program that embeds the core. It simulates the scene of a case file for a second and prints where the first body
// is.
#include <cstdio>

#include "core/world.h"

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "embedding CASE.toml\n"), 2;
  const auto world = rigor::load_world(rigor::read_scene_file(argv[1]), "core:rk4");
  for (int i = 0; i < 1000; ++i) world->step(1e-3);  // s
  rigor::Snapshot now;
  world->read(now);
  const rigor::Vec3 p = now.bodies().position(0);
  std::printf("%.6f %.6f %.6f\n", p.x(), p.y(), p.z());
}
