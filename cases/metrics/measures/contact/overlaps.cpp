#include "cases/metrics/measures/contact/overlaps.h"

#include "cases/metrics/measures/shape_gap.h"
#include "core/dynamics/model/system.h"

namespace rigor::inline metric {

Overlaps::Overlaps(const Scene& scene) : scene_(scene) {
  BodyTable start(scene.bodies.size());
  set_initial_state(scene, start.columns());
  for_each_near_pair(scene, start.columns(), 0, [&](int a, int b, double gap) { at_start_[{a, b}] = -gap; });
}

void Overlaps::visit(BodyColumns bodies, const std::function<void(const Overlap&)>& see) const {
  for_each_near_pair(scene_, bodies, 0, [&](int a, int b, double gap) {
    const auto known = at_start_.find({a, b});
    see({a, b, -gap - (known == at_start_.end() ? 0 : known->second), gap});
  });
}

}  // namespace rigor::inline metric
