// MuJoCo's global state: its two handlers. By its defaults a warning goes to stdout and to a file in the working
// folder, and an error waits for Enter and ends the process.
#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <string>

namespace rigor::mujoco_library {

struct DeleteModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DeleteData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using Model = std::unique_ptr<mjModel, DeleteModel>;
using Data = std::unique_ptr<mjData, DeleteData>;

// From here on an error throws std::runtime_error, and a warning is kept for take_warnings(). May be called repeatedly.
void start();
std::string take_warnings();  // of this thread since the last call; empty if none

// Compiles MJCF; throws InputError with MuJoCo's own words.
Model compile(const std::string& mjcf);
// The same of a file, with its path and line.
Model read_file(const std::string& path);

}  // namespace rigor::mujoco_library
