// Which of many spheres overlap, by a list of neighbours (Verlet, Phys. Rev. 159 (1967) 98): the broad phase is asked
// for the pairs that may meet while no sphere moves by more than a slack along each axis, and the list holds until one
// has. Most steps only see that none has, and look through the pairs of the list. What comes out depends on the spheres
// alone.
#pragma once

#include "core/dynamics/collision/broad_phase.h"
#include "core/dynamics/model/body_constants.h"

namespace rigor {

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

}  // namespace rigor
