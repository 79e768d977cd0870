// MuJoCo's global state: its two handlers. The default handlers write a warning to stdout and to a file in the working
// folder. On an error they wait for Enter and end the process.
#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <string>

namespace rigor::inline adapters::mujoco_library {

struct DeleteModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DeleteData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using Model = std::unique_ptr<mjModel, DeleteModel>;
using Data = std::unique_ptr<mjData, DeleteData>;

// Errors throw std::runtime_error from here on, and warnings are kept for take_warnings(). May be called repeatedly.
void start();
std::string take_warnings();  // of this thread since the last call; empty if none

// Compiles MJCF; throws InputError with MuJoCo's own words.
Model compile(const std::string& mjcf);
// The same of a file, with its path and line.
Model read_file(const std::string& path);

}  // namespace rigor::inline adapters::mujoco_library
