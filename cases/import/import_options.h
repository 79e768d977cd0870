#pragma once

#include <string>

namespace rigor::inline imports {

// How a robot's file is imported.
struct ImportOptions {
  std::string keyframe = "";    // of MJCF, to start from; empty: the model's own state
  bool lossy = false;           // accept that physics is lost
  bool repair_inertia = false;  // replace inertias that no body can have
  bool ground = false;          // add a plane under the lowest point
};

}  // namespace rigor::inline imports
