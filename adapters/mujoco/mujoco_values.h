// What the adapter sets in mjModel itself: the softness of constraints, and the options of contacts. By the names of
// mjModel's arrays, so that a MuJoCo in another process can be told the same.
#pragma once

#include <vector>

#include "core/engine/engine.h"

struct mjModel_;

namespace rigor::inline adapters {

// The place `at` in each row of an array whose rows have `length` numbers.
struct MujocoValue {
  const char* array;
  int length, at;
  double value;
  int per_dt = 0;  // the value is divided by this power of the step, s
};

// Of contacts, to be set once. A named option changes the shipped contacts on either track.
std::vector<MujocoValue> mujoco_contact_values(const Settings& settings);

// Of loops, couplings, limits and friction in joints: on the matched track, for each new step size.
const std::vector<MujocoValue>& mujoco_stiff_values();

void mujoco_set(mjModel_& model, const std::vector<MujocoValue>& values, double dt = 1);

}  // namespace rigor::inline adapters
