#include "cases/import/assembly.h"

#include <fmt/format.h>

#include <set>

#include "cases/import/mass_share.h"
#include "cases/import/rigid_groups.h"
#include "cases/import/touching.h"
#include "core/base/error.h"
#include "core/scene/validate.h"

namespace rigor {
namespace {

// A shape this near to the centre of mass counts as centred. No robot's file distinguishes nanometres.
constexpr double kCentred = 1e-9;  // m

class Assembler {
 public:
  explicit Assembler(LinkModel& model) : model_(model) {}

  Scene scene() {
    take_to_start(model_);
    groups_ = rigid_groups(model_);
    touching_.emplace(model_, groups_.body);
    scene_.gravity = model_.gravity;
    body_.assign(model_.links.size(), kWorld);
    for (int i = 0; i < static_cast<int>(model_.links.size()); ++i) add_link(i);
    add_joints();
    add_springs();
    settle_contacts(model_, *touching_, sources_, scene_);
    if (scene_.bodies.empty())
      throw InputError("nothing in it moves; allowed: at least one link that has mass and is not held by the world");
    validate(scene_);
    return std::move(scene_);
  }

 private:
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
    if (groups_.body[index] != index) return;  // its shapes come with the link that carries it
    const Link& link = model_.links[index];
    LinkInertial inertial = link.inertial.front();
    const std::vector<ShapeSource> shapes = shapes_of(index);
    const ShapeSource* own = nullptr;
    for (const ShapeSource& source : shapes) {
      const bool is_centred = (source.shape->pose.position - inertial.pose.position).norm() <= kCentred;
      if (is_centred && !own) own = &source;
    }
    std::vector<Body> parts;
    std::vector<ShapeSource> part_sources;
    for (const ShapeSource& source : shapes) {
      if (&source != own) add_part(source, shapes.size(), inertial, parts, part_sources);
    }
    if (!parts.empty() && own) {  // the rest's centre of mass is not there any more
      add_part(*own, shapes.size(), inertial, parts, part_sources);
      own = nullptr;
    }
    body_[index] = add_body(moving_with(link, main_body(link, inertial, own)), link.name);
    if (own) keep_source(*own, body_[index]);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const int part = add_body(moving_with(link, parts[k]), link.name);
      keep_source(part_sources[k], part);
      scene_.joints.push_back({body_[index], part, FixedJoint{}});
    }
  }

  static Body moving_with(const Link& link, Body body) {
    body.velocity = link.velocity + link.angular_velocity.cross(body.position - link.pose.position);
    body.angular_velocity = link.angular_velocity;
    return body;
  }

  // Returns the shapes of the link and of links without mass that move with it.
  std::vector<ShapeSource> shapes_of(int index) {
    if (members_.empty()) {
      members_.resize(model_.links.size());
      for (int i = 0; i < static_cast<int>(model_.links.size()); ++i) {
        if (groups_.body[i] >= 0) members_[groups_.body[i]].push_back(i);
      }
    }
    std::vector<ShapeSource> shapes;
    for (const int i : members_[index]) {
      for (const LinkShape& shape : model_.links[i].shapes) {
        if (std::holds_alternative<Plane>(shape.shape)) {
          model_.left_out.add(shape.where, "its plane", "would move, and a scene's planes do not: nothing touches it");
        } else {
          shapes.push_back({-1, i, &shape});
        }
      }
    }
    return shapes;
  }

  void add_part(const ShapeSource& source, std::size_t count, LinkInertial& inertial, std::vector<Body>& parts,
                std::vector<ShapeSource>& sources) {
    const LinkShape& shape = *source.shape;
    const auto share = take_share(inertial, shape.shape, shape.pose, 1.0 / static_cast<double>(count));
    if (!share)
      return model_.left_out.add(shape.where, "its " + shape_name(shape.shape),
                                 "a body there would need more of the link's inertia than it has: nothing touches it");
    model_.left_out.add(shape.where, "its " + shape_name(shape.shape),
                        "changes no motion: becomes a body of its own, fixed to the link's, with a part of its mass");
    Body part;
    part.mass = share->mass, part.inertia = inertia_of(shape.shape, share->mass);
    part.position = shape.pose.position, part.orientation = shape.pose.orientation, part.shape = shape.shape;
    inertial = share->rest;
    parts.push_back(part), sources.push_back(source);
  }

  Body main_body(const Link& link, const LinkInertial& inertial, const ShapeSource* own) const {
    Body body;
    body.mass = inertial.mass, body.position = inertial.pose.position;
    body.orientation = own ? own->shape->pose.orientation : link.pose.orientation;
    const Mat3 turn = matrix_of((body.orientation.conjugate() * inertial.pose.orientation).normalized());
    body.inertia = cleaned(turn * inertial.inertia * turn.transpose());
    if (own) body.shape = own->shape->shape;
    return body;
  }

  // Removes the entries off the diagonal that are only rounding of a turn.
  static Mat3 cleaned(Mat3 inertia) {
    constexpr double kRounding = 1e-15;
    const double largest = inertia.cwiseAbs().maxCoeff();
    inertia = (inertia + inertia.transpose().eval()) / 2;
    return inertia.unaryExpr([&](double value) { return std::abs(value) <= kRounding * largest ? 0.0 : value; });
  }

  void keep_source(ShapeSource source, int body) {
    source.body = body;
    scene_.bodies[body].collides = true;
    sources_.push_back(source);
  }

  void add_static(int index) {
    const Link& link = model_.links[index];
    for (const LinkShape& shape : link.shapes) {
      if (!touching_->can_be_touched(index, shape)) {
        model_.left_out.add(shape.where, "its " + shape_name(shape.shape),
                            "changes no motion: stands still, and nothing that moves may touch it");
        continue;
      }
      Body body;
      body.fixed = true, body.shape = shape.shape;
      if (!std::holds_alternative<Plane>(shape.shape))
        body.position = shape.pose.position, body.orientation = shape.pose.orientation;
      keep_source({-1, index, &shape}, add_body(body, link.name));
    }
  }

  int body_of(int link) const {
    if (link == kWorld || groups_.body[link] == kWorld) return kWorld;
    return groups_.body[link] == RigidGroups::kNone ? RigidGroups::kNone : body_[groups_.body[link]];
  }

  void add_joints() {
    std::vector<int> place(model_.joints.size(), -1);
    for (std::size_t k = 0; k < model_.joints.size(); ++k) {
      const LinkJoint& row = model_.joints[k];
      Joint joint = row.joint;
      joint.a = body_of(joint.a), joint.b = body_of(joint.b);
      if (joint.a == RigidGroups::kNone || joint.b == RigidGroups::kNone) continue;  // which was said of its link
      if (joint.a == joint.b) {
        const bool is_all = std::holds_alternative<FixedJoint>(joint.type);
        if (!is_all) model_.left_out.add(row.where, "the joint", "changes no motion: both its links stand still");
        continue;
      }
      for_each_vector(joint.type, [&](const char*, JointVector kind, Vec3& vector) {
        if (kind == JointVector::point_of_a) vector = in_body(row.joint.a, vector);
        if (kind == JointVector::point_of_b) vector = in_body(row.joint.b, vector);
      });
      if (const auto fault = fault_of(joint, scene_))
        throw InputError(fmt::format("{}: {}{}{}", row.where, fault->key, fault->key.empty() ? "" : ": ", fault->what));
      place[k] = static_cast<int>(scene_.joints.size());
      scene_.joints.push_back(joint);
    }
    for (Motor motor : model_.motors) {
      motor.joint = place[motor.joint];
      if (motor.joint >= 0) scene_.motors.push_back(motor);
    }
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
      if (spring.a == RigidGroups::kNone || spring.b == RigidGroups::kNone || spring.a == spring.b) continue;
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
  std::vector<ShapeSource> sources_;       // that take part in contact
  std::set<std::string> names_;
};

}  // namespace

Scene scene_of(LinkModel& model) { return Assembler(model).scene(); }

}  // namespace rigor
