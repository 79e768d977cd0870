// A program that embeds Rigor's core: reads the scene of a case file, takes a second of it in steps of a millisecond by
// a method of the table, and says where the first body is.
#include <cstdio>

#include "core/dynamics/integrators/integrator.h"
#include "core/scene/toml/scene_reader.h"
#include "core/scene/toml/table_reader.h"

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "embedding CASE.toml\n"), 2;
  const auto file = rigor::TomlFile::read(argv[1]);
  const rigor::Scene scene = rigor::read_scene(file.root({"title", "source", "scene", "run", "truth", "gate"}).at("scene"));
  const rigor::System system(scene);
  rigor::BodyTable state(scene.bodies.size());
  rigor::set_initial_state(scene, state.columns());
  const auto stepper = rigor::integrator("rk4").make({.system = system, .contact = nullptr, .orientation = nullptr});
  for (int i = 0; i < 1000; ++i) stepper->step(state.columns(), 1e-3 * i, 1e-3);
  const rigor::Vec3 p = state.columns().position(0);
  std::printf("%s %.6f %.6f %.6f\n", scene.bodies[0].name.c_str(), p.x(), p.y(), p.z());
}
