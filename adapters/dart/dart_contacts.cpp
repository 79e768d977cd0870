#include "adapters/dart/dart_contacts.h"

#include <fmt/format.h>

#include <dart/collision/CollisionObject.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/SphereShape.hpp>
#include <unordered_map>

#include "core/base/rotation_between.h"
#include "core/engine/engine_failure.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline adapters {
namespace {

namespace dyn = ::dart::dynamics;

// Up to here DART takes a coefficient for zero (ContactConstraint.cpp: DART_RESTITUTION_COEFF_THRESHOLD, …FRICTION…).
constexpr double kTakenForZero = 1e-3;

void refuse_small(double value, const char* what) {
  if (value == 0 || value > kTakenForZero) return;
  throw EngineFailure(
      FailureKind::unsupported,
      fmt::format("DART takes {} of {:g} or less for none, and here it is {:g}", what, kTakenForZero, value));
}

bool same(const ContactLaw& a, const ContactLaw& b) {
  return a.restitution == b.restitution && a.friction == b.friction;
}

// The scene's different laws, by number, and which a body takes part in.
class LawNumbers {
 public:
  explicit LawNumbers(const Scene& scene)
      : of_pairs_(scene), laws_{scene.contact_default}, of_(scene.bodies.size(), {0}) {
    for (const ContactPair& pair : scene.contact_pairs) {
      if (!pair.law.collides) continue;
      const std::size_t number = number_of(pair.law);
      if (number == laws_.size()) laws_.push_back(pair.law);
      of_[pair.a].insert(number), of_[pair.b].insert(number);
    }
    for (const ContactLaw& law : laws_) {
      refuse_small(law.restitution, "a restitution");
      refuse_small(law.friction, "a friction");
    }
  }

  const std::set<std::size_t>& of_body(std::size_t body) const { return of_[body]; }
  const ContactLaw& law(std::size_t number) const { return laws_[number]; }
  std::size_t of_pair(int a, int b) const { return number_of(of_pairs_.of(a, b)); }
  bool may_touch(int a, int b) const { return of_pairs_.may_touch(a, b); }
  // Whether all pairs touch and by the same law.
  bool are_all_alike() const { return laws_.size() == 1 && !of_pairs_.some_are_apart(); }

 private:
  std::size_t number_of(const ContactLaw& law) const {
    const auto found =
        std::find_if(laws_.begin(), laws_.end(), [&](const ContactLaw& other) { return same(law, other); });
    return static_cast<std::size_t>(found - laws_.begin());
  }

  ContactLaws of_pairs_;
  std::vector<ContactLaw> laws_;
  std::vector<std::set<std::size_t>> of_;  // by body
};

// Added to DART's own filter, which excludes pairs of immobile bodies.
class LawFilter : public ::dart::collision::BodyNodeCollisionFilter {
 public:
  explicit LawFilter(const Scene& scene) : laws_(scene) {}

  const LawNumbers& laws() const { return laws_; }
  void add(const dyn::ShapeFrame* shape, int body, std::size_t law) { shapes_[shape] = {body, law}; }

  bool ignoresCollision(const ::dart::collision::CollisionObject* one,
                        const ::dart::collision::CollisionObject* other) const override {
    if (!laws_.are_all_alike()) {
      const auto [a, law_a] = shapes_.at(one->getShapeFrame());
      const auto [b, law_b] = shapes_.at(other->getShapeFrame());
      if (a == b || law_a != law_b || !laws_.may_touch(a, b) || laws_.of_pair(a, b) != law_a) return true;
    }
    return BodyNodeCollisionFilter::ignoresCollision(one, other);
  }

 private:
  struct Place {
    int body;
    std::size_t law;
  };
  LawNumbers laws_;
  std::unordered_map<const dyn::ShapeFrame*, Place> shapes_;
};

struct MakeShape {
  dyn::ShapePtr operator()(const Sphere& s) const { return std::make_shared<dyn::SphereShape>(s.radius); }
  dyn::ShapePtr operator()(const Box& b) const { return std::make_shared<dyn::BoxShape>(b.size); }  // full edges
  dyn::ShapePtr operator()(const Plane&) const {
    return std::make_shared<dyn::BoxShape>(Vec3::Constant(2 * kDartPlaneReach));
  }
  // A compound, whose parts are made, and shapes without a feature: nothing that they could touch.
  template <typename Other>
  dyn::ShapePtr operator()(const Other&) const {
    return nullptr;
  }
};

// Of a box with its face in the plane, over the point of it next to the origin.
Eigen::Isometry3d pose_of_plane(const Plane& plane) {
  const Quat turn = rotation_between(Vec3::UnitZ(), plane.normal);
  return dart_transform((plane.offset - kDartPlaneReach) * plane.normal, turn);
}

void add_dart_part(const dyn::ShapePtr& shape, const BodyPose& pose, std::size_t body, DartBodies& made,
                   LawFilter& filter) {
  for (const std::size_t number : filter.laws().of_body(body)) {
    auto* node = made.bodies[body]->createShapeNodeWith<dyn::CollisionAspect, dyn::DynamicsAspect>(shape);
    node->setRelativeTransform(dart_transform(pose.position, pose.orientation));
    node->getDynamicsAspect()->setFrictionCoeff(filter.laws().law(number).friction);
    node->getDynamicsAspect()->setRestitutionCoeff(std::sqrt(filter.laws().law(number).restitution));
    filter.add(node, static_cast<int>(body), number);
  }
}

}  // namespace

std::shared_ptr<::dart::collision::CollisionFilter> add_dart_shapes(const Scene& scene, DartBodies& made) {
  auto filter = std::make_shared<LawFilter>(scene);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (!body.collides) continue;
    if (const auto* plane = std::get_if<Plane>(&*body.shape))  // it is given in W
      made.bodies[i]->getParentJoint()->setTransformFromParentBodyNode(pose_of_plane(*plane));
    for_each_part(*body.shape, [&](const Shape& part, const BodyPose& pose) {
      if (const dyn::ShapePtr shape = std::visit(MakeShape{}, part)) add_dart_part(shape, pose, i, made, *filter);
    });
  }
  for (const dyn::SkeletonPtr& skeleton : made.skeletons) {  // joined bodies touch each other like any others
    skeleton->enableSelfCollisionCheck();
    skeleton->enableAdjacentBodyCheck();
  }
  return filter;
}

DartPlaneEdges::DartPlaneEdges(const Scene& scene) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (!body.collides) continue;
    if (const auto* plane = std::get_if<Plane>(&*body.shape)) {
      planes_.push_back(*plane), names_.push_back(body.name);
    } else if (!body.fixed) {
      solids_.push_back({i, body.name, bounding_radius(*body.shape)});
    }
  }
}

void DartPlaneEdges::check(BodyColumns bodies) const {
  for (std::size_t p = 0; p < planes_.size(); ++p) {
    const Vec3& normal = planes_[p].normal;
    for (const Solid& solid : solids_) {
      const Vec3 position = bodies.position(solid.body);
      const double height = normal.dot(position) - planes_[p].offset;
      const double beside = (position - normal.dot(position) * normal).norm();
      if (height > solid.bounding_radius || beside + solid.bounding_radius < kDartPlaneReach) continue;
      throw EngineFailure(
          beside > 2 * kDartPlaneReach ? FailureKind::diverged : FailureKind::unsupported,
          fmt::format(
              "body '{}' is {:.0f} m from the point of plane '{}' nearest to the origin. DART's box for a plane "
              "ends at {:g} m",
              solid.name, beside, names_[p], kDartPlaneReach));
    }
  }
}

}  // namespace rigor::inline adapters
