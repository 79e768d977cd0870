#include <algorithm>
#include <dart/collision/dart/DARTCollisionDetector.hpp>
#include <dart/constraint/BoxedLcpConstraintSolver.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/simulation/World.hpp>

#include "bench/raw_engines.h"

namespace rigor::bench {
namespace {

namespace dyn = ::dart::dynamics;

class RawDart : public RawWorld {
 public:
  explicit RawDart(const Scene& scene) : world_(::dart::simulation::World::create()) {
    world_->setGravity(scene.gravity);
    for (const Body& body : scene.bodies) add(body);
    auto solver = std::make_unique<::dart::constraint::BoxedLcpConstraintSolver>();
    solver->setCollisionDetector(::dart::collision::DARTCollisionDetector::create());
    world_->setConstraintSolver(std::move(solver));
  }

  void run(int steps, double dt, std::vector<double>& out) override {
    out.resize(13 * bodies_.size());
    world_->setTimeStep(dt);
    for (int n = 0; n < steps; ++n) {
      world_->step();
      read(out);
    }
  }

 private:
  void add(const Body& body) {
    const auto skeleton = dyn::Skeleton::create(body.name);
    const auto [joint, node] = skeleton->createJointAndBodyNodePair<dyn::FreeJoint>();
    node->setInertia(dyn::Inertia(body.mass, Vec3::Zero(), body.inertia));
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translate(body.position).rotate(body.orientation);
    dyn::FreeJoint::setTransformOf(joint, pose);
    joint->setLinearVelocity(body.velocity), joint->setAngularVelocity(body.angular_velocity);
    bodies_.push_back(node);
    world_->addSkeleton(skeleton);
  }

  void read(std::vector<double>& out) const {
    double* to = out.data();
    for (const dyn::BodyNode* body : bodies_) {
      const Eigen::Isometry3d& pose = body->getWorldTransform();
      const Quat q(pose.linear());
      const Vec3 x = pose.translation(), v = body->getLinearVelocity(), w = body->getAngularVelocity();
      to = std::copy_n(x.data(), 3, to);
      for (const double part : {q.w(), q.x(), q.y(), q.z()}) *to++ = part;
      to = std::copy_n(v.data(), 3, to);
      to = std::copy_n(w.data(), 3, to);
    }
  }

  ::dart::simulation::WorldPtr world_;
  std::vector<dyn::BodyNode*> bodies_;
};

}  // namespace

std::unique_ptr<RawWorld> raw_dart(const Scene& scene) { return std::make_unique<RawDart>(scene); }

}  // namespace rigor::bench
