// In place of core/scene/shapes/hull.cpp where Qhull's source could not be fetched: a scene with a hull is refused.
#include <stdexcept>

#include "core/base/error.h"
#include "core/scene/shapes/hull.h"

namespace rigor::inline scene {

std::shared_ptr<const Hull> hull_of(const std::vector<Vec3>&) {
  throw InputError("this build has no convex hulls: Qhull's source was not fetched when it was built");
}

// Nothing calls these, because no hull can be made.
std::size_t Hull::furthest(const Vec3&) const { throw std::logic_error("no hulls"); }
TriangleMesh Hull::drawn() const { throw std::logic_error("no hulls"); }
std::shared_ptr<const Hull> scaled_hull(const Hull&, double) { throw std::logic_error("no hulls"); }
std::shared_ptr<const Hull> mirrored_hull(const Hull&) { throw std::logic_error("no hulls"); }

}  // namespace rigor::inline scene
