// Changes of a scene that faults of more than one kind make.
#pragma once

#include <functional>

#include "core/scene/scene.h"

namespace rigor::test {

template <typename F>
std::function<void(Scene&)> each_body(F change) {
  return [change](Scene& scene) {
    for (Body& body : scene.bodies) change(body);
  };
}

inline void equal_masses(Scene& scene) {
  double sum = 0, count = 0;
  for (const Body& body : scene.bodies) {
    if (!body.fixed) sum += body.mass, ++count;
  }
  for (Body& body : scene.bodies) body.mass = sum / count;
}

}  // namespace rigor::test
