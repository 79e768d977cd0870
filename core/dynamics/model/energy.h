// Energy and momenta of a scene's bodies, computed only from their states and the scene, never by an engine.
#pragma once

#include "core/engine/body_table.h"
#include "core/scene/scene.h"

namespace rigor::inline dynamics {

double kinetic_energy_of(const Scene& scene, BodyColumns bodies, std::size_t i);  // J, of one body; 0 if fixed
double kinetic_energy(const Scene& scene, BodyColumns bodies);                    // J
double potential_energy(const Scene& scene,
                        BodyColumns bodies);  // J, gravity (zero at W's origin), springs, joints' springs
inline double energy(const Scene& scene, BodyColumns bodies) {
  return kinetic_energy(scene, bodies) + potential_energy(scene, bodies);
}
Vec3 linear_momentum(const Scene& scene, BodyColumns bodies);                        // kg m/s, in W
Vec3 angular_momentum(const Scene& scene, BodyColumns bodies, const Vec3& about_W);  // kg m²/s, in W

}  // namespace rigor::inline dynamics
