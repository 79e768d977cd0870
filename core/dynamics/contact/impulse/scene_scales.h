// The length and the time by which contact by impulses measures a scene, so that its thresholds do not depend on units.
#pragma once

#include "core/scene/scene.h"

namespace rigor {

struct SceneScales {
  double length;  // m: half the edge of a cube of a body's volume, the mean over the moving bodies that collide
  double time;    // s: in which a body at rest starts to cross its own length; infinite if nothing moves it
  double speed() const { return length / time; }  // m/s
};

SceneScales scales_of(const Scene& scene);

}  // namespace rigor
