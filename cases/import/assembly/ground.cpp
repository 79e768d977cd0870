#include "cases/import/assembly/ground.h"

#include <algorithm>
#include <limits>

#include "core/base/error.h"

namespace rigor::inline imports {

void add_ground(LinkModel& model) {
  const Vec3 up = model.gravity.isZero(0) ? Vec3::UnitZ().eval() : (-model.gravity).normalized();
  double lowest = std::numeric_limits<double>::infinity();
  for (const Link& link : model.links) {
    for (const LinkShape& shape : link.shapes) {
      if (std::holds_alternative<Plane>(shape.shape))
        return model.left_out.add(shape.where, "--ground", assumed("adds nothing: the model has a plane of its own"));
      const Vec3 corner = support(shape.shape, shape.pose.orientation.conjugate() * -up);
      lowest = std::min(lowest, up.dot(shape.pose.position + shape.pose.orientation * corner));
    }
  }
  if (lowest == std::numeric_limits<double>::infinity())
    throw InputError("--ground: no link has a shape that could touch the ground; allowed: a model with <collision>");
  Link ground{"ground", model.name + ": --ground", {}};
  ground.is_static = true, ground.touches_own_model = true;
  for (const Link& link : model.links) ground.model = std::max(ground.model, link.model + 1);
  LinkShape plane{Plane{up, lowest}, {}, {0, kGroundFriction}, ~0u, ~0u, ground.where};
  ground.shapes.push_back(plane);
  model.links.push_back(std::move(ground));
}

}  // namespace rigor::inline imports
