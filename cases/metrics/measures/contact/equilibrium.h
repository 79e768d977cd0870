// The contact forces that follow from the equations of motion. Each moving body gives six equations, and each contact
// point has an unknown force. A pair's resultant is determined in those directions whose rows lie in the row
// space of the equations' matrix. In statics this is the question of statical determinacy.
#pragma once

#include <map>
#include <set>
#include <vector>

#include "cases/metrics/measures/contact/meeting_points.h"
#include "cases/metrics/measures/contact/pair_wrenches.h"

namespace rigor::inline metric {

// What a body's motion asks of its contacts, in W. A fixed body asks for nothing.
struct ContactLoad {
  Vec3 force = Vec3::Zero();   // N
  Vec3 moment = Vec3::Zero();  // N m, about the origin of W
  Vec3 centre = Vec3::Zero();  // m, of mass
  double scale = 0;            // N, of the forces on the body: an error far below it does not count
  bool is_fixed = false;
};

// The wrench on a pair's second body, as far as it is determined. The projectors `force_counts` and `moment_counts`
// tell in which directions it is: zero in none, the identity in all.
struct DueWrench {
  PairWrench wrench;
  Mat3 force_counts = Mat3::Zero(), moment_counts = Mat3::Zero();
};

struct Equilibrium {
  std::map<BodyPair, DueWrench> pairs;
  std::set<int> unexplained;  // bodies whose load no force at the points explains

  // For any pair. One without points has no force, unless one of its bodies is unexplained.
  DueWrench due(const BodyPair& pair) const;
};

bool counts_fully(const Mat3& counts);

// `loads`: one for each body.
Equilibrium equilibrium_of(const std::vector<MeetingPoint>& points, std::vector<ContactLoad> loads);

}  // namespace rigor::inline metric
