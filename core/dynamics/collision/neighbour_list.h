// Finds which of many spheres overlap with a neighbour list (Verlet, Phys. Rev. 159 (1967) 98). The broad phase finds
// the pairs that may meet while no sphere moves by more than a slack along each axis. The list is valid until a sphere
// has moved further. Most steps only check this and the listed pairs. The result depends only on the spheres.
#pragma once

#include "core/dynamics/collision/broad_phase.h"
#include "core/dynamics/model/body_constants.h"

namespace rigor::inline engine {
class StateArchive;
}

namespace rigor::inline dynamics {

struct Ball {
  int body;
  double radius;  // m
};

class NeighbourList {
 public:
  explicit NeighbourList(std::vector<Ball> balls);

  // Each pair (first < second by their place among the balls) that overlaps, in ascending order. Meant to be called
  // once a step. `spheres`: columns of SphereColumn, of which kFoundAt is kept here.
  const std::vector<std::pair<int, int>>& overlaps(const Bodies& bodies, BodyColumns state, Columns& spheres);

  // Restores the neighbours that were found, and not only which spheres overlap. `spheres` as in overlaps().
  void archive_state(StateArchive& archive, Columns& spheres);

 private:
  bool overlap(int a, int b, BodyColumns state) const;
  void choose_slack(BodyColumns state, const Columns& spheres);
  void search(BodyColumns state);

  std::vector<Ball> balls_;
  double largest_radius_ = 0;  // m
  Vec3 slack_ = Vec3::Zero();  // m: how far a ball may move along each axis while the list holds
  double steps_to_hold_ = 32;  // for which the slack is chosen
  int steps_held_ = 0;         // 0: nothing has been searched for
  BroadPhase broad_phase_;
  std::vector<Aabb> boxes_;                                 // of the balls, wider by the slack
  const std::vector<std::pair<int, int>>* near_ = nullptr;  // may meet while the list holds
  std::vector<std::pair<int, int>> pairs_;                  // that overlap
};

}  // namespace rigor::inline dynamics
