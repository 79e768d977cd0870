#include <btBulletDynamicsCommon.h>

#include "bench/raw_engines.h"

namespace rigor::bench {
namespace {

btVector3 vector_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

class RawBullet : public RawWorld {
 public:
  explicit RawBullet(const Scene& scene) {
    world_.setGravity(vector_of(scene.gravity));
    for (const Body& body : scene.bodies) add(body);
  }
  ~RawBullet() override {
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }
  RawBullet(const RawBullet&) = delete;
  RawBullet& operator=(const RawBullet&) = delete;

  void run(int steps, double dt, std::vector<double>& out) override {
    out.resize(13 * bodies_.size());
    for (int n = 0; n < steps; ++n) {
      world_.stepSimulation(dt, 0);
      double* to = out.data();
      for (const auto& body : bodies_) {
        const btTransform& pose = body->getWorldTransform();
        const btQuaternion q = pose.getRotation();
        put(pose.getOrigin(), to);
        *to++ = q.w(), *to++ = q.x(), *to++ = q.y(), *to++ = q.z();
        put(body->getLinearVelocity(), to);
        put(body->getAngularVelocity(), to);
      }
    }
  }

 private:
  static void put(const btVector3& v, double*& to) { *to++ = v.x(), *to++ = v.y(), *to++ = v.z(); }

  void add(const Body& body) {
    btRigidBody::btRigidBodyConstructionInfo start(body.mass, nullptr, &no_shape_, vector_of(body.inertia.diagonal()));
    const Quat& q = body.orientation;
    start.m_startWorldTransform = btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), vector_of(body.position));
    auto& made = bodies_.emplace_back(std::make_unique<btRigidBody>(start));
    made->setLinearVelocity(vector_of(body.velocity));
    made->setAngularVelocity(vector_of(body.angular_velocity));
    made->setActivationState(DISABLE_DEACTIVATION);
    made->setDamping(0, 0);
    world_.addRigidBody(made.get(), btBroadphaseProxy::DefaultFilter, 0);
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broad_phase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broad_phase_, &solver_, &configuration_};
  btEmptyShape no_shape_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

}  // namespace

std::unique_ptr<RawWorld> raw_bullet(const Scene& scene) { return std::make_unique<RawBullet>(scene); }

}  // namespace rigor::bench
