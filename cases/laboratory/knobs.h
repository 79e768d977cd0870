// The values of a scene that the laboratory's sliders change. A scene has only the knobs that mean something in it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace rigor::inline laboratory {

// A knob acts on all springs, bodies or pairs at once; if these differ, `value` is that of the first. With stiffness
// and mass the others keep their ratio to it. With damping, restitution and friction all get the same value.
struct Knob {
  std::string name;   // "stiffness": the key in an address
  std::string label;  // "Stiffness of the springs"
  std::string unit;   // "N/m"; empty for a number
  double value = 0;   // the scene's own; may be infinite where `may_be_infinite`
  double least = 0, most = 0;
  bool is_logarithmic = false;
  bool may_be_infinite = false;
};

using KnobValues = std::map<std::string, double>;  // by Knob::name

std::vector<Knob> knobs_of(const Scene& scene);

// The scene with these values. Throws InputError for a knob that the scene does not have, and for a value out of range.
Scene with_knobs(const Scene& scene, const KnobValues& values);

}  // namespace rigor::inline laboratory
