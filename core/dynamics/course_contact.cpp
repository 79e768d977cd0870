// The course's impulse collision of a sphere and the ground (Computational Models of Motion 2021, assignment 5,
// exercise 3): where the sphere overlaps the plane and its lowest point approaches it, the impulse j = K⁻¹ (u' - u)
// takes that point's velocity u to u' = -e u_n n, without any tangential part (infinite friction). K is the inverse
// effective mass of the point. The position is left alone: the overlap is what the coarse step makes of it.
#include <Eigen/LU>

#include "core/dynamics/contact.h"

namespace rigor {
namespace {

struct SphereOnPlane {
  int sphere;
  double radius;  // m
  Plane plane;
  double restitution;  // 0..1
};

class CourseContact : public Contact {
 public:
  CourseContact(const Scene& scene, const System& system) : system_(system) {
    for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) add_pairs_of(scene, i);
  }

  bool can_touch() const { return !pairs_.empty(); }

  void resolve(MutableBodyColumns state) const override {
    for (const SphereOnPlane& pair : pairs_) resolve(pair, state);
  }

 private:
  void add_pairs_of(const Scene& scene, int i) {
    const Body& body = scene.bodies[i];
    if (!body.collides || body.fixed) return;
    for (int k = 0; k < static_cast<int>(scene.bodies.size()); ++k) {
      const Body& other = scene.bodies[k];
      if (!other.collides || !std::holds_alternative<Plane>(*other.shape)) continue;
      pairs_.push_back({i, std::get<Sphere>(*body.shape).radius, std::get<Plane>(*other.shape),
                        scene.contact_law(i, k).restitution});
    }
  }

  void resolve(const SphereOnPlane& pair, MutableBodyColumns state) const {
    const Vec3 n = pair.plane.normal;
    const double gap = n.dot(state.position(pair.sphere)) - pair.plane.offset - pair.radius;
    const Vec3 arm = -pair.radius * n;
    const Vec3 v = state.velocity(pair.sphere), w = state.angular_velocity(pair.sphere);
    const Vec3 u = v + w.cross(arm);
    if (gap >= 0 || n.dot(u) >= 0) return;

    const Inertia& body = system_.bodies[pair.sphere];
    const Mat3 R = state.rotation(pair.sphere);
    const Mat3 inverse_inertia_W = R * body.inverse_inertia_B * R.transpose();
    const Mat3 arm_cross = cross_matrix(arm);
    const Mat3 K = body.inverse_mass * Mat3::Identity() - arm_cross * inverse_inertia_W * arm_cross;
    const Vec3 wanted = -pair.restitution * n.dot(u) * n;
    const Vec3 impulse = K.inverse() * (wanted - u);
    state.set_velocity(pair.sphere, v + body.inverse_mass * impulse);
    state.set_angular_velocity(pair.sphere, w + inverse_inertia_W * arm.cross(impulse));
  }

  const System& system_;
  std::vector<SphereOnPlane> pairs_;
};

}  // namespace

const ContactMethod kCourseContact = {
    "course",
    "the course's impulse: a sphere on a plane, restitution, infinite friction",
    {"contact:plane-sphere", "friction:infinite", "restitution"},
    [](const Scene& scene, const System& system) -> std::unique_ptr<Contact> {
      auto contact = std::make_unique<CourseContact>(scene, system);
      if (!contact->can_touch()) return nullptr;
      return contact;
    },
};

}  // namespace rigor
