// The program itself, run as a process in a folder of the test. For files to which RIGOR_PROGRAM is told.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "generated/tests/places.h"
#include "tests/folder.h"

namespace rigor {

// Thrown without forces but gravity: semi-implicit Euler is off by g t dt/2 in position, 5 m/s × dt after 1 s.
inline constexpr const char* kThrown = R"(title = "thrown"
[scene]
gravity = [0, -10, 0]
[[scene.body]]
name = "stone"
mass = 2
inertia = [1, 1, 1]
velocity = [1, 0, 0]
[run]
duration = 1
dt = ["1/10"]
[truth]
kind = "projectile"
)";

// A free body that spins about all its axes, with a closed form. `more`: further lines of the body.
inline std::string tumbling_top(const std::string& name, const std::string& more = "") {
  return "title = \"a top\"\n[scene]\n[[scene.body]]\nname = \"" + name + R"("
mass = 2
inertia = [1, 2, 3]
angular_velocity = [1.1, 0.7, -0.9]
)" + more +
         R"([run]
duration = 3
dt = ["1/100"]
[truth]
kind = "asymmetric-top"
)";
}

// Up and down on a spring, w = 10/s; with a closed form.
inline constexpr const char* kSprungCube = R"(title = "up and down"
[scene]
gravity = [0, -10, 0]
[[scene.body]]
name = "cube"
mass = 100
inertia = [1, 1, 1]
position = [0, 0.1, 0]
[[scene.spring]]
a = "world"
point_a = [0, 2, 0]
b = "cube"
stiffness = 1e4
rest_length = 1.5
[run]
duration = 5
dt = ["1/30", "1/100"]
[truth]
kind = "oscillator"
)";

struct Program {
  struct Answer {
    int code;
    std::string out, err;
  };
  Folder folder;

  std::string path(const std::string& name) const { return (folder.path / name).string(); }
  std::string content(const std::string& name) const {
    std::ifstream stream(folder.path / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  // In the folder, which names of files are from.
  Answer run(const std::vector<std::string>& words) const {
    std::string command = "cd '" + folder.path.string() + "' && '" RIGOR_PROGRAM "'";
    for (const std::string& word : words) command += " '" + word + "'";
    const int status = std::system((command + " >stdout 2>stderr").c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content("stdout"), content("stderr")};
  }
};

}  // namespace rigor
