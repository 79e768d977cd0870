#include "cases/truth/solved/jointed/jointed_ways.h"
#include "cases/truth/solved/jointed/natural_coordinates.h"

namespace rigor::inline truth::solving {
namespace {

template <typename Real>
void compare_with(Judged& judged, const Scene& scene, const Way& way, const std::vector<double>& switches) {
  const NaturalCoordinates<double> writer(scene);
  judged.compare([&](const double* state, MutableBodyColumns out) { writer.write(state, out); },
                 nodes_of<NaturalCoordinates<Real>>(scene, way, switches));
}

}  // namespace

void compare_with_natural(Judged& judged, Precision precision, const Scene& scene, const Way& way,
                          const std::vector<double>& switches) {
  if (precision == Precision::extended) return compare_with<Extended>(judged, scene, way, switches);
  compare_with<double>(judged, scene, way, switches);
}

}  // namespace rigor::inline truth::solving
