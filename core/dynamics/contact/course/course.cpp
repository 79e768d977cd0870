// The course's impulse collision for spheres on planes and on each other (Computational Models of Motion 2021,
// assignment 5, exercise 3). It acts where two bodies overlap and the relative velocity u of the contact point
// approaches. The impulse j = K⁻¹ (u' - u) changes it to u' = -e u_n n, without tangential part (infinite friction). K
// is the inverse effective mass of the two bodies at the point. Positions stay unchanged, so the overlap follows from
// the coarse step. Contacts are processed one after another, each once. The method suits single bounces, not piles.
#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "core/dynamics/collision/neighbour_list.h"
#include "core/dynamics/contact/contact_method.h"
#include "core/engine/state_archive.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline dynamics {
namespace {

struct Ground {
  int body;
  Plane plane;
};

// One body's share in a contact: the velocity of its point, and the effect of an impulse at the point.
struct Side {
  int body;
  Vec3 arm;  // from the centre of mass to the point, in W
};

std::vector<Ball> balls_of(const Scene& scene) {
  std::vector<Ball> balls;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const Body& body = scene.bodies[i];
    if (!body.collides) continue;
    if (const auto* sphere = std::get_if<Sphere>(&*body.shape)) balls.push_back({i, sphere->radius});
  }
  return balls;
}

// The impulses of one step. An integrator may resolve contacts several times in it.
class CourseImpulses : public ReportsContacts {
 public:
  void ask_for_contacts() override { is_asked_ = true; }
  std::vector<ReportedContact> contacts() const override { return contacts_; }

  void begin_step() { contacts_.clear(); }
  void add(ReportedContact contact) {  // its force is an impulse yet [N s]
    if (is_asked_) contacts_.push_back(std::move(contact));
  }
  void end_step(double dt) {
    for (ReportedContact& contact : contacts_) contact.force /= dt;
  }

 private:
  bool is_asked_ = false;
  std::vector<ReportedContact> contacts_;
};

class CourseContact : public Contact {
 public:
  CourseContact(const Scene& scene, const System& system)
      : system_(system),
        laws_(scene),
        balls_(balls_of(scene)),
        spheres_(kSphereColumns, scene.bodies.size()),
        below_(spheres_.stride()),
        neighbours_(balls_) {
    double* const radii = spheres_.column(kRadius);
    std::fill_n(radii, spheres_.stride(), -std::numeric_limits<double>::infinity());
    for (const Ball& ball : balls_) radii[ball.body] = ball.radius;
    for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
      const Body& body = scene.bodies[i];
      if (!body.collides) continue;
      if (const auto* plane = std::get_if<Plane>(&*body.shape)) grounds_.push_back({i, *plane});
    }
  }

  void resolve(MutableBodyColumns state) override {
    for (const Ground& ground : grounds_) resolve_on_ground(ground, state);
    if (balls_.size() < 2) return;
    for (const auto& [a, b] : neighbours_.overlaps(system_.constants.all(), state, spheres_))
      resolve_balls(balls_[a], balls_[b], state);
  }

  void archive_state(StateArchive& archive) { neighbours_.archive_state(archive, spheres_); }

  CourseImpulses impulses;

 private:
  // A plane is fixed: where its own point lies does not matter.
  void resolve_on_ground(const Ground& ground, MutableBodyColumns state) {
    const Vec3& n = ground.plane.normal;
    const double plane[] = {n.x(), n.y(), n.z(), ground.plane.offset};
    const std::size_t count =
        kernels().below_plane(system_.constants.all(), state.column(0), spheres_.data(), plane, below_.data());
    for (std::size_t k = 0; k < count; ++k) {
      const int ball = below_[k];
      const double radius = spheres_.column(kRadius)[ball],
                   gap = n.dot(state.position(ball)) - ground.plane.offset - radius;
      bounce({ball, -radius * n}, {ground.body, Vec3::Zero()}, n, gap, state);
    }
  }

  void resolve_balls(const Ball& a, const Ball& b, MutableBodyColumns state) {
    const Vec3 line = state.position(a.body) - state.position(b.body);
    const double distance = line.norm();
    if (distance == 0) return;  // no direction to part in
    const Vec3 n = line / distance;
    // One point for both, in the middle of the overlap, so that the pair keeps its angular momentum.
    const double half_depth = 0.5 * (a.radius + b.radius - distance);
    bounce({a.body, (half_depth - a.radius) * n}, {b.body, (b.radius - half_depth) * n}, n, -2 * half_depth, state);
  }

  // n points from b to a; gap [m].
  void bounce(const Side& a, const Side& b, const Vec3& n, double gap, MutableBodyColumns state) {
    if (!laws_.may_touch(a.body, b.body)) return;
    const Vec3 u = point_velocity(a, state) - point_velocity(b, state);
    const double speed = n.dot(u);
    if (speed >= 0) return;
    const Mat3 turning_a = inverse_inertia_in_world(a.body, state), turning_b = inverse_inertia_in_world(b.body, state);
    const Mat3 K = inverse_effective_mass(a, turning_a) + inverse_effective_mass(b, turning_b);
    if (K.isZero(0)) return;  // two fixed bodies
    const Vec3 target_velocity = -laws_.of(a.body, b.body).restitution * speed * n;
    const Vec3 impulse = K.inverse() * (target_velocity - u);
    push(a, turning_a, impulse, state);
    push(b, turning_b, -impulse, state);
    impulses.add({a.body, b.body, state.position(a.body) + a.arm, -n, gap, -impulse});
  }

  static Vec3 point_velocity(const Side& side, BodyColumns state) {
    return state.velocity(side.body) + state.angular_velocity(side.body).cross(side.arm);
  }

  // 1/(kg m²), in W.
  Mat3 inverse_inertia_in_world(int body, BodyColumns state) const {
    const Inertia& inertia = system_.bodies[body];
    if (inertia.fixed) return Mat3::Zero();
    const Mat3 R = state.rotation(body);
    return R * inertia.inverse_inertia_B * R.transpose();
  }

  Mat3 inverse_effective_mass(const Side& side, const Mat3& turning) const {
    const Inertia& inertia = system_.bodies[side.body];
    if (inertia.fixed) return Mat3::Zero();
    const Mat3 arm = cross_matrix(side.arm);
    return inertia.inverse_mass * Mat3::Identity() - arm * turning * arm;
  }

  void push(const Side& side, const Mat3& turning, const Vec3& impulse, MutableBodyColumns state) const {
    const Inertia& inertia = system_.bodies[side.body];
    if (inertia.fixed) return;
    state.set_velocity(side.body, state.velocity(side.body) + inertia.inverse_mass * impulse);
    state.set_angular_velocity(side.body, state.angular_velocity(side.body) + turning * side.arm.cross(impulse));
  }

  const System& system_;
  ContactLaws laws_;
  std::vector<Ground> grounds_;
  std::vector<Ball> balls_;
  Columns spheres_;                  // columns of SphereColumn, by body
  std::vector<std::int32_t> below_;  // the plane
  NeighbourList neighbours_;
};

class CourseStepper : public ContactStepper {
 public:
  CourseStepper(const Scene& scene, const ContactParts& parts)
      : contact_(scene, parts.system),
        stepper_(parts.integrator.make({parts.system, &contact_, parts.orientation, parts.settings})) {}

  void step(MutableBodyColumns state, double t, double dt) override {
    contact_.impulses.begin_step();
    stepper_->step(state, t, dt);
    contact_.impulses.end_step(dt);
  }
  ReportsContacts* contact_reports() override { return &contact_.impulses; }
  std::string solver_warning() const override { return stepper_->solver_warning(); }
  void archive_state(StateArchive& archive) override {
    archive(contact_);
    stepper_->archive_state(archive);
  }

 private:
  CourseContact contact_;
  std::unique_ptr<Stepper> stepper_;
};

}  // namespace

extern const ContactMethod kCourseContact;
const ContactMethod kCourseContact = {
    .name = "course",
    .summary = "the course's impulse: spheres on planes and on each other, restitution, infinite friction",
    .features = {Feature::contact_filter, contact_feature<Plane, Sphere>(), contact_feature<Sphere, Sphere>(),
                 Feature::friction_infinite, Feature::restitution},
    .make = make_contact_stepper<CourseStepper>,
};

}  // namespace rigor::inline dynamics
