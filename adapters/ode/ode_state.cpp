// Saves and restores a world of ODE, which has no such function of its own. A world remembers the bodies, the seed of
// QuickStep's shuffles, the turns of hinges, and the order in which its space lists the shapes: contacts are found in
// that order. It cannot be given the order in which the space's sort left shapes of equal position.
#include <algorithm>
#include <array>

#include "adapters/ode/ode_world.h"

namespace rigor::inline adapters {
namespace {

template <std::size_t N>
std::array<dReal, N> numbers_at(const dReal* from) {
  std::array<dReal, N> numbers;
  std::copy_n(from, N, numbers.begin());
  return numbers;
}

// Through the pointers that ODE returns to its own numbers. dBodySetQuaternion() normalises a unit quaternion again,
// and its last digits change.
template <std::size_t N>
void put_bits(const std::array<dReal, N>& numbers, const dReal* into) {
  std::copy(numbers.begin(), numbers.end(), const_cast<dReal*>(into));
}

}  // namespace

void OdeWorld::archive_state(StateArchive& archive) {
  archive(clock_, lost_, random_seed_, solver_warning_, loads_, *joints_);
  for (const dBodyID body : bodies_)
    if (body) archive_body(archive, body);
  archive_order(archive);
}

void OdeWorld::archive_body(StateArchive& archive, dBodyID body) {
  auto p = numbers_at<3>(dBodyGetPosition(body)), v = numbers_at<3>(dBodyGetLinearVel(body)),
       w = numbers_at<3>(dBodyGetAngularVel(body));
  auto q = numbers_at<4>(dBodyGetQuaternion(body));
  auto R = numbers_at<12>(dBodyGetRotation(body));
  archive(p, q, R, v, w);
  if (!archive.restores()) return;
  dBodySetPosition(body, p[0], p[1], p[2]);  // also tells the body's shapes that they have moved
  dBodySetLinearVel(body, v[0], v[1], v[2]);
  dBodySetAngularVel(body, w[0], w[1], w[2]);
  put_bits(q, dBodyGetQuaternion(body));
  put_bits(R, dBodyGetRotation(body));
}

void OdeWorld::archive_order(StateArchive& archive) {
  std::vector<int> order(geoms_.size());  // places among geoms_
  for (std::size_t i = 0; i < geoms_.size(); ++i) {
    const auto at = std::find(geoms_.begin(), geoms_.end(), dSpaceGetGeom(moving_, static_cast<int>(i)));
    order[i] = static_cast<int>(at - geoms_.begin());
  }
  archive.each(order, [&](int& place) { archive(place); });
  if (!archive.restores()) return;
  for (const dGeomID geom : geoms_) dSpaceRemove(moving_, geom);
  for (const int place : order) dSpaceAdd(moving_, geoms_.at(static_cast<std::size_t>(place)));
}

}  // namespace rigor::inline adapters
