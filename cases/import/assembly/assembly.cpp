#include "cases/import/assembly/assembly.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "cases/import/assembly/ground.h"
#include "cases/import/assembly/joint_zeros.h"
#include "cases/import/assembly/joints_in_series.h"
#include "cases/import/assembly/rigid_groups.h"
#include "cases/import/assembly/touching.h"
#include "core/base/error.h"
#include "core/scene/validate.h"

namespace rigor::inline imports {
namespace {

// A shape this near to the centre of mass counts as centred. No robot's file distinguishes nanometres.
constexpr double kCentred = 1e-9;  // m

class Assembler {
 public:
  explicit Assembler(LinkModel& model) : model_(model) {}

  Scene scene(bool with_ground) {
    take_to_start(model_);
    if (with_ground) add_ground(model_);
    groups_ = rigid_groups(model_);
    check_that_something_moves();
    touching_.emplace(model_, groups_.body);
    scene_.gravity = model_.gravity;
    body_.assign(model_.links.size(), kWorld);
    find_members();
    for (int i = 0; i < static_cast<int>(model_.links.size()); ++i) add_link(i);
    add_joints();
    add_couplings();
    add_springs();
    settle_contacts(model_, *touching_, sources_, scene_);
    validate(scene_);
    return std::move(scene_);
  }

 private:
  void check_that_something_moves() const {
    std::vector<std::string> without_mass;
    for (std::size_t i = 0; i < model_.links.size(); ++i) {
      if (groups_.body[i] >= 0) return;
      if (model_.links[i].inertial.empty() && without_mass.size() < 10) without_mass.push_back(model_.links[i].name);
    }
    const std::string which =
        without_mass.empty() ? "" : fmt::format(". Without mass: {}", fmt::join(without_mass, ", "));
    throw InputError("nothing in it moves; allowed: at least one link that has mass and is not held by the world" +
                     which);
  }

  void find_members() {
    members_.resize(model_.links.size());
    for (int i = 0; i < static_cast<int>(model_.links.size()); ++i) {
      if (groups_.body[i] >= 0) members_[groups_.body[i]].push_back(i);
    }
  }

  // Returns "arm", then "arm/2", "arm/3".
  std::string free_name(const std::string& wanted) {
    std::string name = wanted == "world" ? "world/link" : wanted;
    for (int n = 2; !names_.insert(name).second; ++n) name = fmt::format("{}/{}", wanted, n);
    return name;
  }

  int add_body(Body body, const std::string& name) {
    body.name = free_name(name);
    scene_.bodies.push_back(std::move(body));
    return static_cast<int>(scene_.bodies.size()) - 1;
  }

  void add_link(int index) {
    if (groups_.body[index] == kWorld) return add_static(index);
    if (groups_.body[index] != index) return;  // it comes with the link that carries it
    const Link& link = model_.links[index];
    const LinkInertial& inertial = groups_.inertial[index];
    const std::vector<ContactSource::Part> shapes = shapes_of(index);
    Body body;
    body.mass = inertial.mass, body.position = inertial.pose.position, body.orientation = link.pose.orientation;
    const bool is_own =
        shapes.size() == 1 && (shapes.front().shape->pose.position - inertial.pose.position).norm() <= kCentred;
    if (is_own) {
      body.orientation = shapes.front().shape->pose.orientation, body.shape = shapes.front().shape->shape;
    } else if (!shapes.empty()) {
      body.shape = compound_of(shapes, {body.position, body.orientation});
    }
    const Mat3 turn = matrix_of((body.orientation.conjugate() * inertial.pose.orientation).normalized());
    body.inertia = cleaned(turn * inertial.inertia * turn.transpose());
    if (const std::string why = why_no_inertia(body.inertia); !why.empty())
      throw InputError(fmt::format("{}: no body has the inertia of what moves with it: {}", link.where, why));
    body.velocity = link.velocity + link.angular_velocity.cross(body.position - link.pose.position);
    body.angular_velocity = link.angular_velocity;
    body.collides = !shapes.empty();
    body_[index] = add_body(body, link.name);
    if (!shapes.empty()) sources_.push_back({body_[index], index, shapes});
    add_lifts(index);
  }

  static Compound compound_of(const std::vector<ContactSource::Part>& shapes, const BodyPose& body) {
    Compound compound;
    for (const ContactSource::Part& part : shapes)
      compound.parts.push_back({part.shape->shape, inverse(body) * part.shape->pose});
    return compound;
  }

  // Forces against the weight of links on which gravity does not act, or not in full.
  void add_lifts(int index) {
    for (const int member : members_[index]) {
      const Link& link = model_.links[member];
      if (link.lifted == 0 || link.inertial.empty() || model_.gravity.isZero(0)) continue;
      TimedForce lift;
      lift.body = body_[index], lift.force = -link.lifted * link.inertial.front().mass * model_.gravity;
      lift.point = (inverse(scene_.pose(body_[index])) * link.inertial.front().pose).position;
      scene_.forces.push_back(lift);
    }
  }

  // Returns the shapes of the link and of those that move with it.
  std::vector<ContactSource::Part> shapes_of(int index) {
    std::vector<ContactSource::Part> shapes;
    for (const int i : members_[index]) {
      for (const LinkShape& shape : model_.links[i].shapes) {
        if (std::holds_alternative<Plane>(shape.shape)) {
          model_.left_out.add(shape.where, "a plane",
                              lost("would move, and a scene's planes do not: nothing touches it"));
        } else {
          shapes.push_back({i, &shape});
        }
      }
    }
    return shapes;
  }

  // Removes the entries off the diagonal that are only rounding of a turn.
  static Mat3 cleaned(Mat3 inertia) {
    constexpr double kRounding = 1e-15;
    const double largest = inertia.cwiseAbs().maxCoeff();
    inertia = (inertia + inertia.transpose().eval()) / 2;
    return inertia.unaryExpr([&](double value) { return std::abs(value) <= kRounding * largest ? 0.0 : value; });
  }

  void add_static(int index) {
    const Link& link = model_.links[index];
    for (const LinkShape& shape : link.shapes) {
      if (!touching_->can_be_touched(index, shape)) {
        model_.left_out.add(shape.where, "a " + shape_name(shape.shape),
                            no_motion("stands still, and nothing that moves may touch it"));
        continue;
      }
      Body body;
      body.fixed = body.collides = true, body.shape = shape.shape;
      if (!std::holds_alternative<Plane>(shape.shape))
        body.position = shape.pose.position, body.orientation = shape.pose.orientation;
      sources_.push_back({add_body(body, link.name), index, {{index, &shape}}});
    }
  }

  int body_of(int link) const {
    if (link == kWorld || groups_.body[link] == kWorld) return kWorld;
    return groups_.body[link] < 0 ? groups_.body[link] : body_[groups_.body[link]];
  }

  void add_joints() {
    const auto note_driven = [&](int joint, const std::vector<JointTerm>& others) {
      model_.joints[joint].is_driven = true;
      for (const JointTerm& term : others) model_.joints[term.joint].is_driven = true;
    };
    for (const Motor& motor : model_.motors) note_driven(motor.joint, motor.plus);
    for (const LinkCoupling& row : model_.couplings) note_driven(row.joint, row.to);
    place_.assign(model_.joints.size(), -1);
    for (std::size_t k = 0; k < model_.joints.size(); ++k) {
      const LinkJoint& row = model_.joints[k];
      const int a = body_of(row.joint.a), b = body_of(row.joint.b);
      if (a == RigidGroups::kNone || b == RigidGroups::kNone) continue;  // which was said of its link
      if (b == RigidGroups::kBetween) {
        if (a != RigidGroups::kBetween) add_series(static_cast<int>(k));
      } else if (a != RigidGroups::kBetween) {
        add_joint(static_cast<int>(k), a, b);
      }
    }
    for (const Motor& motor : model_.motors) add_motor(motor);
  }

  void add_joint(int k, int a, int b) {
    const LinkJoint& row = model_.joints[k];
    Joint joint = row.joint;
    joint.a = a, joint.b = b;
    if (a == b) {
      const bool is_all = std::holds_alternative<FixedJoint>(joint.type);
      if (!is_all) model_.left_out.add(row.where, "the joint", no_motion("its links do not move against each other"));
      return;
    }
    for_each_vector(joint.type, [&](const char*, JointVector kind, Vec3& vector) {
      if (kind == JointVector::point_of_a) vector = in_body(row.joint.a, vector);
      if (kind == JointVector::point_of_b) vector = in_body(row.joint.b, vector);
    });
    if (const auto fault = fault_of(joint, scene_))
      throw InputError(fmt::format("{}: {}{}{}", row.where, fault->key, fault->key.empty() ? "" : ": ", fault->what));
    joint.armature = row.armature;
    place_[k] = static_cast<int>(scene_.joints.size());
    scene_.joints.push_back(joint);
    add_friction(k);
  }

  void add_motor(Motor motor) {
    const std::string& where = model_.joints[motor.joint].where;
    const bool has_places = renumber(motor, place_), is_of_one = motor.plus.empty();
    if (!has_places && is_of_one) return;  // which was said of its joint
    const auto fault = has_places && !is_of_one ? fault_of(motor, scene_) : std::nullopt;
    if (has_places && !fault) return scene_.motors.push_back(motor);
    model_.left_out.add(where, "a servo on several joints",
                        lost(fault ? fault->what : "one of them has no axis of its own in the scene"));
  }

  void add_couplings() {
    for (LinkCoupling row : model_.couplings) {
      if (!renumber(row, place_)) {
        model_.left_out.add(row.where, "a coupling", lost("one of its joints has no axis of its own in the scene"));
        continue;
      }
      const Coupling coupling{row.joint, row.to};  // counts from the start, where take_to_start() has closed it
      scene_.couplings.push_back(coupling);
      const auto fault = fault_of(coupling, scene_);
      const auto circle = fault_of_circle(scene_.couplings, scene_.couplings.size() - 1, scene_);
      if (!fault && !circle) continue;
      scene_.couplings.pop_back();
      model_.left_out.add(row.where, "a coupling", lost(fault ? fault->what : circle->what));
    }
  }

  void add_friction(int k) {
    if (model_.joints[k].friction == 0) return;
    Motor friction;
    friction.joint = place_[k], friction.speed = 0, friction.most = model_.joints[k].friction;
    friction.is_friction = true;
    scene_.motors.push_back(friction);
  }

  // Follows links without mass from joint k on, which leads to the first of them.
  void add_series(int k) {
    std::vector<int> chain = {k};
    std::vector<const LinkJoint*> rows = {&model_.joints[k]};
    int end = model_.joints[k].joint.b;
    while (body_of(end) == RigidGroups::kBetween) {
      const int next = joint_below(end);
      if (next < 0)
        throw InputError(fmt::format("{}: moves between other links without mass; allowed: joints in a row",
                                     model_.links[end].where));
      chain.push_back(next), rows.push_back(&model_.joints[next]);
      end = model_.joints[next].joint.b;
    }
    const JointSeries series = joints_in_series(rows, body_of(model_.joints[k].joint.a), body_of(end));
    if (series.rows.empty())
      return model_.left_out.add(model_.joints[k].where, "joints in series",
                                 lost("no joint of a scene equals them: the two links come apart"));
    for (std::size_t i = 0; i < chain.size(); ++i) {
      if (series.place[i] >= 0) place_[chain[i]] = static_cast<int>(scene_.joints.size()) + series.place[i];
    }
    scene_.joints.insert(scene_.joints.end(), series.rows.begin(), series.rows.end());
    for (std::size_t i = 0; i < chain.size(); ++i) {
      if (series.place[i] >= 0) add_friction(chain[i]);
    }
  }

  // The joint that leads on from a link without mass, or from one on a fixed joint to it.
  int joint_below(int link) const {
    for (std::size_t k = 0; k < model_.joints.size(); ++k) {
      const Joint& joint = model_.joints[k].joint;
      const bool leads_on = joint.a != kWorld && groups_.set[joint.a] == groups_.set[link] && free_axis(joint);
      if (leads_on && groups_.set[joint.b] != groups_.set[link]) return static_cast<int>(k);
    }
    return -1;
  }

  // Takes a point from a link's frame to the frame of its body.
  Vec3 in_body(int link, const Vec3& point) const {
    const Vec3 in_W = link == kWorld ? point : (model_.links[link].pose * BodyPose{point}).position;
    const int body = body_of(link);
    return body < 0 ? in_W : (inverse(scene_.pose(body)) * BodyPose{in_W}).position;
  }

  void add_springs() {
    for (const Spring& row : model_.springs) {
      Spring spring = row;
      spring.a = body_of(row.a), spring.b = body_of(row.b);
      if (spring.a < kWorld || spring.b < kWorld || spring.a == spring.b) continue;
      spring.point_a = in_body(row.a, row.point_a), spring.point_b = in_body(row.b, row.point_b);
      scene_.springs.push_back(spring);
    }
  }

  LinkModel& model_;
  Scene scene_;
  RigidGroups groups_;
  std::optional<Touching> touching_;
  std::vector<int> body_;                  // by link: its body in the scene
  std::vector<std::vector<int>> members_;  // by link: those that move with it
  std::vector<int> place_;                 // by joint: its row in the scene, or -1
  std::vector<ContactSource> sources_;     // that take part in contact
  std::set<std::string> names_;
};

}  // namespace

Scene scene_of(LinkModel& model, bool with_ground) { return Assembler(model).scene(with_ground); }

}  // namespace rigor::inline imports
