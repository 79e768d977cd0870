#include "adapters/bullet/bullet_state.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "core/base/error.h"

namespace rigor::inline adapters::bullet {
namespace {

void archive_vector(StateArchive& archive, btVector3& v) { archive(v.m_floats[0], v.m_floats[1], v.m_floats[2]); }

void archive_transform(StateArchive& archive, btTransform& pose) {
  for (int row = 0; row < 3; ++row) archive_vector(archive, pose.getBasis()[row]);
  archive_vector(archive, pose.getOrigin());
}

void archive_body_state(StateArchive& archive, btRigidBody& body) {
  btTransform pose = body.getWorldTransform(), interpolated = body.getInterpolationWorldTransform();
  btVector3 v = body.getLinearVelocity(), w = body.getAngularVelocity(),
            v_interpolated = body.getInterpolationLinearVelocity(),
            w_interpolated = body.getInterpolationAngularVelocity();
  btScalar hit = body.getHitFraction();
  archive_transform(archive, pose), archive_transform(archive, interpolated);
  for (btVector3* vector : {&v, &w, &v_interpolated, &w_interpolated}) archive_vector(archive, *vector);
  archive(hit);
  if (!archive.restores()) return;
  body.setLinearVelocity(v), body.setAngularVelocity(w);
  body.setCenterOfMassTransform(pose);  // also turns the inertia
  body.setInterpolationWorldTransform(interpolated);
  body.setInterpolationLinearVelocity(v_interpolated), body.setInterpolationAngularVelocity(w_interpolated);
  body.setHitFraction(hit);
}

void archive_point(StateArchive& archive, btManifoldPoint& point) {
  for (btVector3* vector :
       {&point.m_localPointA, &point.m_localPointB, &point.m_positionWorldOnA, &point.m_positionWorldOnB,
        &point.m_normalWorldOnB, &point.m_lateralFrictionDir1, &point.m_lateralFrictionDir2})
    archive_vector(archive, *vector);
  archive(point.m_distance1, point.m_combinedFriction, point.m_combinedRollingFriction,
          point.m_combinedSpinningFriction, point.m_combinedRestitution, point.m_partId0, point.m_partId1,
          point.m_index0, point.m_index1, point.m_contactPointFlags, point.m_appliedImpulse, point.m_prevRHS,
          point.m_appliedImpulseLateral1, point.m_appliedImpulseLateral2, point.m_contactMotion1,
          point.m_contactMotion2, point.m_contactCFM, point.m_contactERP, point.m_frictionCFM, point.m_lifeTime);
}

using Pair = std::pair<int, int>;  // of collision objects, by their places in the world

struct Points {
  Pair of;
  std::vector<btManifoldPoint> points;
};

class Contacts {
 public:
  explicit Contacts(btDiscreteDynamicsWorld& world)
      : objects_(world.getCollisionObjectArray()), cache_(*world.getPairCache()), dispatcher_(*world.getDispatcher()) {
    for (int i = 0; i < objects_.size(); ++i) places_[objects_[i]] = i;
  }

  std::vector<Pair> pairs() const {
    std::vector<Pair> pairs;
    const btBroadphasePairArray& listed = cache_.getOverlappingPairArray();
    for (int i = 0; i < listed.size(); ++i)
      pairs.emplace_back(place_of(listed[i].m_pProxy0->m_clientObject), place_of(listed[i].m_pProxy1->m_clientObject));
    return pairs;
  }

  void set_pairs(const std::vector<Pair>& pairs) {
    const btBroadphasePairArray& listed = cache_.getOverlappingPairArray();
    while (listed.size() > 0) cache_.removeOverlappingPair(listed[0].m_pProxy0, listed[0].m_pProxy1, &dispatcher_);
    for (const auto& [a, b] : pairs) cache_.addOverlappingPair(proxy(a), proxy(b));
  }

  std::vector<Points> points() const {
    std::vector<Points> all;
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
      const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(i);
      all.push_back({bodies_of(manifold), {}});
      for (int k = 0; k < manifold.getNumContacts(); ++k) all.back().points.push_back(manifold.getContactPoint(k));
    }
    return all;
  }

  // In the order that is given; manifolds that it does not name come last, without points.
  void set_points(const std::vector<Points>& all) {
    std::vector<btPersistentManifold*> left, ordered;
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) left.push_back(dispatcher_.getManifoldByIndexInternal(i));
    for (const Points& saved : all) {
      const auto at = std::find_if(left.begin(), left.end(), [&](const btPersistentManifold* manifold) {
        return bodies_of(*manifold) == saved.of;
      });
      if (at == left.end()) continue;
      set_points_of(**at, saved.points);
      ordered.push_back(*at), left.erase(at);
    }
    for (btPersistentManifold* manifold : left) manifold->clearManifold(), ordered.push_back(manifold);
    for (std::size_t i = 0; i < ordered.size(); ++i) {
      dispatcher_.getInternalManifoldPointer()[i] = ordered[i];
      ordered[i]->m_index1a = static_cast<int>(i);
    }
  }

 private:
  static void set_points_of(btPersistentManifold& manifold, const std::vector<btManifoldPoint>& points) {
    manifold.clearManifold();
    const int count = std::min(static_cast<int>(points.size()), MANIFOLD_CACHE_SIZE);
    manifold.setNumContacts(count);
    for (int k = 0; k < count; ++k) manifold.getContactPoint(k) = points[static_cast<std::size_t>(k)];
  }
  int place_of(const void* object) const { return places_.at(object); }
  Pair bodies_of(const btPersistentManifold& manifold) const {
    return {place_of(manifold.getBody0()), place_of(manifold.getBody1())};
  }
  btBroadphaseProxy* proxy(int place) const {
    if (place < 0 || place >= objects_.size())
      throw InputError("the saved state does not fit this world: it names a body that is not there");
    return objects_[place]->getBroadphaseHandle();
  }

  btCollisionObjectArray& objects_;
  btOverlappingPairCache& cache_;
  btDispatcher& dispatcher_;
  std::map<const void*, int> places_;
};

template <typename Visit>
void for_each_body(btDiscreteDynamicsWorld& world, const Visit& visit) {
  btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) visit(*btRigidBody::upcast(objects[i]));
}

}  // namespace

void archive_bodies(StateArchive& archive, btDiscreteDynamicsWorld& world) {
  for_each_body(world, [&](btRigidBody& body) { archive_body_state(archive, body); });
}

// Bullet makes a pair's manifold when it looks for the pair's contacts. What it finds there is then replaced.
void archive_contacts(StateArchive& archive, btDiscreteDynamicsWorld& world) {
  Contacts contacts(world);
  std::vector<Pair> pairs = contacts.pairs();
  std::vector<Points> points = contacts.points();
  archive(pairs);
  archive.resized(points);
  for (Points& of_pair : points) {
    archive(of_pair.of);
    archive.resized(of_pair.points);
    for (btManifoldPoint& point : of_pair.points) archive_point(archive, point);
  }
  if (!archive.restores()) return;
  for_each_body(world, [](btRigidBody& body) { body.forceActivationState(ACTIVE_TAG); });
  contacts.set_pairs(pairs);
  world.getDispatcher()->dispatchAllCollisionPairs(world.getPairCache(), world.getDispatchInfo(),
                                                   world.getDispatcher());
  contacts.set_points(points);
}

void archive_sleep(StateArchive& archive, btDiscreteDynamicsWorld& world) {
  for_each_body(world, [&](btRigidBody& body) {
    int state = body.getActivationState();
    btScalar slow_for = body.getDeactivationTime();
    archive(state, slow_for);
    body.forceActivationState(state);
    body.setDeactivationTime(slow_for);
  });
}

}  // namespace rigor::inline adapters::bullet
