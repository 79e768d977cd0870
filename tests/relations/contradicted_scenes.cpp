// Scenes with contacts whose truths once contradicted those of related scenes.
#include "cases/case/case_reader.h"
#include "tests/cases/vocabulary.h"
#include "tests/relations/scenes.h"

namespace rigor::test {
namespace {

// The form of a case file, with the digits that matter.
Scene read(const std::string& bodies, const char* law) {
  const std::string text = "title = \"x\"\n[scene]\ngravity = [0.0, 0.0, -9.81]\n" + bodies +
                           "[scene.contact_default]\n" + law +
                           "\n[run]\nduration = 1.0\ndt = [\"1/60\"]\n[truth]\nkind = \"events\"\n";
  return read_case_text(text, "x.toml", "x", words()).scene;
}

Scene slip_begins() {
  return read(R"(
[[scene.body]]
name = "b"
mass = 1.0
position = [0.0, 0.0, 0.38]
orientation_wxyz = [-0.05, -0.84, -0.44, 0.31]
velocity = [0.74, -1.88, -0.18]
angular_velocity = [-0.78, 0.86, -2.02]
shape = { type = "capsule", radius = 0.12, length = 0.2 }
[[scene.body]]
name = "floor"
shape = { type = "plane", normal = [-0.04, 0.04, 1.0], offset = 0.0 }
)",
              "restitution = 0.0\nfriction = 0.9");
}

Scene box_of_units() {
  return read(R"(
[[scene.body]]
name = "box"
mass = 1.1404545898567802
inertia = [0.03108639440590965, 0.04835230098873487, 0.029511302830021402]
position = [1.4439011804929862, 0.08984409533410523, 0.6430576260235336]
orientation_wxyz = [-0.6533423367478914, 0.44826006200855334, -0.5324434791403397, 0.2978433301952943]
velocity = [0.3412340954622506, -0.047177746543831334, 0.20775825665086123]
angular_velocity = [0.4948521243089403, 1.817577904359152, -1.5239177717049]
shape = { type = "box", size = [0.31948356238692277, 0.23447421540696628, 0.2274894829007822] }
[[scene.body]]
name = "floor"
shape = { type = "plane", normal = [0, 0, 1], offset = 0.0 }
)",
              "restitution = 0\nfriction = 0.2");
}

Scene box_of_mirror_72() {
  return read(R"(
[[scene.body]]
name = "b3"
mass = 3.58
position = [-0.6, 0.67, 1.34]
orientation_wxyz = [0.14, -0.24, -0.2, 0.94]
velocity = [-0.71, 0.19, -0.67]
angular_velocity = [2.19, 0.53, -1.02]
shape = { type = "box", size = [0.34, 0.3, 0.2] }
[[scene.body]]
name = "floor"
shape = { type = "plane", normal = [-0.19, -0.05, 1.0], offset = 0.0 }
)",
              "restitution = 0.0\nfriction = 0.9");
}

Scene box_of_mirror_76() {
  return read(R"(
[[scene.body]]
name = "b2"
mass = 2.68
position = [-0.33, -0.55, 0.64]
orientation_wxyz = [0.89, 0.41, 0.21, -0.07]
velocity = [-0.29, -0.62, 1.17]
angular_velocity = [0.81, -1.25, -0.18]
shape = { type = "box", size = [0.33, 0.36, 0.32] }
[[scene.body]]
name = "floor"
shape = { type = "plane", normal = [-0.01, 0.1, 1.0], offset = 0.0 }
)",
              "restitution = 0.0\nfriction = 0.5");
}

}  // namespace

Scene once_contradicted(unsigned seed) {
  switch (seed % kContradicted) {
    case 0:
      return slip_begins();
    case 1:
      return box_of_units();
    case 2:
      return box_of_mirror_72();
    case 3:
      return box_of_mirror_76();
    // A ball rolls past the end of a capsule. The acceleration of its contact jumps there, wherever the steps end.
    case 4:
      return bodies_on_plane(9045);
    // A box clatters between two of its edges while it slides. The last bounces are no higher than roundings of a gap.
    default:
      return bodies_on_plane(9188);
  }
}

}  // namespace rigor::test
