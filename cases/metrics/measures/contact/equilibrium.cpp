#include "cases/metrics/measures/contact/equilibrium.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/eigen_of.h"

namespace rigor::inline metric {
namespace {

// A singular value below the first, of the largest, is zero: an error of the geometry would grow by its inverse. A
// truth's points are good to 1e-12 of a body's size, so the forces are good to 1e-8.
constexpr double kIndependent = 1e-4;
// Of a unit row: what remains of it outside the row space. Roundings leave 1e-12, independent rows 1e-4 and more.
constexpr double kInRowSpace = 1e-6;
// Loads that no forces at the points explain may be so large, as a share of the bodies' scale. The truth's velocities
// are good to 1e-9 of it.
constexpr double kExplained = 1e-6;
constexpr Eigen::Index kMostUnknowns = 600;  // of one island, whose decomposition then takes a second

std::size_t at(int body) { return static_cast<std::size_t>(body); }

struct Unknown {
  BodyPair pair;
  Vec3 point;      // m, in W
  Vec3 direction;  // unit
  bool is_couple;
};

std::vector<Unknown> unknowns_of(const MeetingPoint& point) {
  std::vector<Unknown> unknowns;
  const auto add = [&](const Vec3& direction, bool is_couple) {
    unknowns.push_back({point.pair, point.point, direction, is_couple});
  };
  if (!point.has_friction) add(point.normal, false);
  for (int axis = 0; axis < 3; ++axis) {
    if (point.has_friction) add(Vec3::Unit(axis), false);
    if (point.has_couple) add(Vec3::Unit(axis), true);
  }
  return unknowns;
}

// The force of an unknown, and its moment about `centre` in units of `length`.
Eigen::Matrix<double, 6, 1> wrench_of(const Unknown& unknown, const Vec3& centre, double length) {
  Eigen::Matrix<double, 6, 1> wrench;
  if (unknown.is_couple) {
    wrench << Vec3::Zero(), unknown.direction;
  } else {
    wrench << unknown.direction, (unknown.point - centre).cross(unknown.direction) / length;
  }
  return wrench;
}

// Bodies that touch each other, with the pairs between them.
class Island {
 public:
  Island(const std::vector<MeetingPoint>& points, const std::vector<ContactLoad>& loads,
         const std::set<BodyPair>& pairs)
      : loads_(loads), pairs_(pairs) {
    for (const MeetingPoint& point : points) {
      if (!pairs.contains(point.pair)) continue;
      for (const int body : {point.pair.first, point.pair.second}) {
        if (loads[at(body)].is_fixed) continue;
        row_of_.try_emplace(body, 6 * static_cast<Eigen::Index>(row_of_.size()));
        length_ = std::max(length_, (point.point - loads[at(body)].centre).norm());
      }
      for (const Unknown& unknown : unknowns_of(point)) unknowns_.push_back(unknown);
    }
    if (!(length_ > 0)) length_ = 1;  // m: no force has a moment
  }

  void solve(Equilibrium& out) const {
    if (static_cast<Eigen::Index>(unknowns_.size()) > kMostUnknowns) return leave_open(out);
    const Eigen::MatrixXd equations = matrix();
    const Eigen::VectorXd load = right_side();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(equations, Eigen::ComputeThinU | Eigen::ComputeThinV);
    const auto& sizes = svd.singularValues();
    Eigen::Index rank = 0;
    while (rank < sizes.size() && sizes[rank] > kIndependent * sizes[0]) ++rank;
    const Eigen::MatrixXd U = svd.matrixU().leftCols(rank), V = svd.matrixV().leftCols(rank);
    const Eigen::VectorXd parts = U.transpose() * load;
    if ((load - U * parts).norm() > kExplained * scale()) return leave_open(out, true);
    const Eigen::VectorXd forces = V * (parts.array() / sizes.head(rank).array()).matrix();
    for (const BodyPair& pair : pairs_) {
      const Eigen::MatrixXd resultant = resultant_of(pair);
      const Eigen::Matrix<double, 6, 1> found = resultant * forces;
      const Eigen::MatrixXd rest = resultant - (resultant * V) * V.transpose();
      DueWrench& due = out.pairs[pair];
      due.wrench = {found.head<3>(), length_ * found.tail<3>()};
      due.force_counts = directions_without(rest.topRows<3>());
      due.moment_counts = directions_without(rest.bottomRows<3>());
    }
  }

 private:
  void leave_open(Equilibrium& out, bool is_unexplained = false) const {
    for (const BodyPair& pair : pairs_) out.pairs[pair] = {};
    if (!is_unexplained) return;
    for (const auto& [body, row] : row_of_) out.unexplained.insert(body);
  }

  Eigen::MatrixXd matrix() const {
    Eigen::MatrixXd equations = Eigen::MatrixXd::Zero(6 * static_cast<Eigen::Index>(row_of_.size()),
                                                      static_cast<Eigen::Index>(unknowns_.size()));
    for (Eigen::Index k = 0; k < equations.cols(); ++k) {
      const Unknown& unknown = unknowns_[static_cast<std::size_t>(k)];
      for (const int body : {unknown.pair.first, unknown.pair.second}) {
        if (loads_[at(body)].is_fixed) continue;
        const double sign = body == unknown.pair.second ? 1 : -1;
        equations.block<6, 1>(row_of_.at(body), k) = sign * wrench_of(unknown, loads_[at(body)].centre, length_);
      }
    }
    return equations;
  }

  Eigen::VectorXd right_side() const {
    Eigen::VectorXd load(6 * static_cast<Eigen::Index>(row_of_.size()));
    for (const auto& [body, row] : row_of_) {
      const ContactLoad& of = loads_[at(body)];
      load.segment<3>(row) = of.force;
      load.segment<3>(row + 3) = (of.moment - of.centre.cross(of.force)) / length_;
    }
    return load;
  }

  double scale() const {
    double sum = 0;
    for (const auto& [body, row] : row_of_) sum += loads_[at(body)].scale;
    return sum;
  }

  // The rows that give a pair's force and moment from all unknowns.
  Eigen::MatrixXd resultant_of(const BodyPair& pair) const {
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(6, static_cast<Eigen::Index>(unknowns_.size()));
    for (Eigen::Index k = 0; k < rows.cols(); ++k) {
      const Unknown& unknown = unknowns_[static_cast<std::size_t>(k)];
      if (unknown.pair == pair) rows.col(k) = wrench_of(unknown, loads_[at(pair.second)].centre, length_);
    }
    return rows;
  }

  // Projects on the directions u in which u' rest is zero.
  static Mat3 directions_without(const Eigen::MatrixXd& rest) {
    const SymmetricEigen found = eigen_of(Mat3(rest * rest.transpose()));
    Mat3 counts = Mat3::Zero();
    for (int k = 0; k < 3; ++k) {
      const Vec3 direction = found.vectors.col(k);
      if (found.values[k] <= kInRowSpace * kInRowSpace) counts += direction * direction.transpose();
    }
    return counts;
  }

  const std::vector<ContactLoad>& loads_;
  const std::set<BodyPair>& pairs_;
  std::vector<Unknown> unknowns_;
  std::map<int, Eigen::Index> row_of_;
  double length_ = 0;  // m, so that moments have the scale of forces
};

// A moving body of only one open pair gets from it all that its other pairs do not give, wherever its points are.
class Peeling {
 public:
  Peeling(std::set<BodyPair>& open, std::vector<ContactLoad>& loads) : open_(open), loads_(loads) {}

  void peel(Equilibrium& out) {
    while (const std::optional<std::pair<BodyPair, int>> found = next()) {
      const auto [pair, leaf] = *found;
      const ContactLoad& load = loads_[at(leaf)];
      const double sign = leaf == pair.second ? 1 : -1;
      DueWrench& due = out.pairs[pair];
      due.wrench.force = sign * load.force;
      due.wrench.moment = sign * load.moment - loads_[at(pair.second)].centre.cross(due.wrench.force);
      due.force_counts = due.moment_counts = Mat3::Identity();
      ContactLoad& other = loads_[at(leaf == pair.second ? pair.first : pair.second)];
      other.force += load.force, other.moment += load.moment, other.scale += load.scale;
      loads_[at(leaf)].force = loads_[at(leaf)].moment = Vec3::Zero();
      open_.erase(pair);
    }
  }

 private:
  std::ptrdiff_t pairs_of(int body) const {
    return std::count_if(open_.begin(), open_.end(),
                         [&](const BodyPair& pair) { return pair.first == body || pair.second == body; });
  }
  std::optional<std::pair<BodyPair, int>> next() const {
    for (const BodyPair& pair : open_)
      for (const int body : {pair.second, pair.first})
        if (!loads_[at(body)].is_fixed && pairs_of(body) == 1) return std::pair(pair, body);
    return std::nullopt;
  }

  std::set<BodyPair>& open_;
  std::vector<ContactLoad>& loads_;
};

// All open pairs that a chain of moving bodies connects with the first; they are taken out of `open`.
std::set<BodyPair> take_island(std::set<BodyPair>& open, const std::vector<ContactLoad>& loads) {
  std::set<BodyPair> island;
  std::set<int> bodies = {open.begin()->second};
  for (bool has_grown = true; has_grown;) {
    has_grown = false;
    for (auto pair = open.begin(); pair != open.end();) {
      if (!bodies.contains(pair->first) && !bodies.contains(pair->second)) {
        ++pair;
        continue;
      }
      for (const int body : {pair->first, pair->second})
        if (!loads[at(body)].is_fixed) bodies.insert(body);
      island.insert(*pair), pair = open.erase(pair), has_grown = true;
    }
  }
  return island;
}

}  // namespace

DueWrench Equilibrium::due(const BodyPair& pair) const {
  const bool is_open = unexplained.contains(pair.first) || unexplained.contains(pair.second);
  const auto found = pairs.find(pair);
  if (!is_open && found != pairs.end()) return found->second;
  DueWrench none;
  if (!is_open) none.force_counts = none.moment_counts = Mat3::Identity();
  return none;
}

bool counts_fully(const Mat3& counts) {
  constexpr double kThree = 2.5;  // a projector's trace is its rank
  return counts.trace() > kThree;
}

Equilibrium equilibrium_of(const std::vector<MeetingPoint>& points, std::vector<ContactLoad> loads) {
  std::set<BodyPair> open;
  for (const MeetingPoint& point : points) open.insert(point.pair);
  Equilibrium out;
  Peeling(open, loads).peel(out);
  std::set<int> in_islands;
  for (const BodyPair& pair : open) in_islands.insert({pair.first, pair.second});
  while (!open.empty()) {
    const std::set<BodyPair> island = take_island(open, loads);
    Island(points, loads, island).solve(out);
  }
  for (int body = 0; body < static_cast<int>(loads.size()); ++body) {
    const ContactLoad& left = loads[at(body)];
    if (left.is_fixed || in_islands.contains(body)) continue;
    if (left.force.norm() > kExplained * left.scale) out.unexplained.insert(body);
  }
  return out;
}

}  // namespace rigor::inline metric
