#include "adapters/bullet/bullet_convert.h"

#include "adapters/bullet/bullet_surface.h"
#include "core/base/eigen_of.h"

namespace rigor::inline adapters::bullet {
namespace {

// Ours: a box by full edge lengths, Bullet's by half ones; likewise a cylinder's length. Both: a capsule along z by the
// length of the cylinder alone, without its caps; a plane by n · x = d with the solid behind it.
struct MakeShape {
  Shapes& shapes;  // takes the parts of a compound
  bool has_margins;

  std::unique_ptr<btCollisionShape> operator()(const Sphere& s) const {
    return std::make_unique<btSphereShape>(s.radius);
  }
  std::unique_ptr<btCollisionShape> operator()(const Box& b) const {
    return std::make_unique<btBoxShape>(to_bullet(Vec3(0.5 * b.size)));
  }
  std::unique_ptr<btCollisionShape> operator()(const Capsule& c) const {
    return std::make_unique<btCapsuleShapeZ>(c.radius, c.length);
  }
  std::unique_ptr<btCollisionShape> operator()(const Compound& c) const {
    auto compound = std::make_unique<btCompoundShape>(true, static_cast<int>(c.parts.size()));
    for (const PlacedShape& part : c.parts) {
      auto own = std::visit(*this, part.shape);
      shapes.push_back(std::move(own));
      const BodyPose& pose = part.pose;
      compound->addChildShape(btTransform(to_bullet(pose.orientation), to_bullet(pose.position)), shapes.back().get());
    }
    return compound;
  }
  // Bullet rounds a hull off by a margin of 4 cm outside it. A matched hull has none.
  std::unique_ptr<btCollisionShape> operator()(const Convex& c) const {
    auto hull = std::make_unique<btConvexHullShape>();
    for (const Vec3& point : c.hull->points) hull->addPoint(to_bullet(point), false);
    hull->recalcLocalAabb();
    if (!has_margins) hull->setMargin(0);
    return hull;
  }
  std::unique_ptr<btCollisionShape> operator()(const Cylinder& c) const {
    return std::make_unique<btCylinderShapeZ>(btVector3(c.radius, c.radius, 0.5 * c.length));
  }
  // Bullet has no such shape: no feature of its contacts names it.
  template <typename Other>
  requires(!std::is_base_of_v<SurfaceShape, Other>) std::unique_ptr<btCollisionShape>
  operator()(const Other&) const { return std::make_unique<btEmptyShape>(); }
  // Bullet has height fields of its own; here both are the triangles of the scene. A matched surface has no margin, and
  // its inner edges are known.
  std::unique_ptr<btCollisionShape> operator()(const SurfaceShape& on) const {
    return std::make_unique<SurfaceOfTriangles>(*on.surface, !has_margins);
  }
  std::unique_ptr<btCollisionShape> operator()(const Plane& p) const {
    return std::make_unique<btStaticPlaneShape>(to_bullet(p.normal), p.offset);
  }
};

}  // namespace

PrincipalFrame principal_frame(const Mat3& inertia_B) {
  if (inertia_B.isDiagonal(0)) return {inertia_B.diagonal(), Mat3::Identity(), false};
  const SymmetricEigen principal = eigen_of(inertia_B);
  Mat3 axes = principal.vectors;                  // its columns are P's axes in B
  if (axes.determinant() < 0) axes.col(0) *= -1;  // right-handed
  return {principal.values, axes, true};
}

btCollisionShape* add_shape(const Shape& shape, const PrincipalFrame& frame, bool has_margins, Shapes& shapes) {
  auto own = std::visit(MakeShape{shapes, has_margins}, shape);
  shapes.push_back(std::move(own));
  btCollisionShape* made = shapes.back().get();
  if (!frame.turned) return made;
  // A child turned from B into P; without a tree of bounding boxes, which one child does not need.
  auto compound = std::make_unique<btCompoundShape>(false);
  compound->addChildShape(btTransform(to_bullet(Mat3(frame.R_BP.transpose()))), made);
  shapes.push_back(std::move(compound));
  return shapes.back().get();
}

}  // namespace rigor::inline adapters::bullet
