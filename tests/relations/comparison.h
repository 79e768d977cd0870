// Compares the motion of generated scenes with those of related scenes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/relations/relations.h"
#include "tests/relations/runs.h"

namespace rigor::test {

// Of one relation over many scenes.
struct Tally {
  int scenes = 0, broken = 0;
  double largest = 0;  // m and rad apart
  double nearest = 0;  // the largest share of its bound
  std::string worst;   // the scene in which that is, with its seed
};

struct Tallies {
  int scenes = 0, supported = 0;
  // Scenes, each by the share of its time before the motion is chaotic, the run gives up, or a truth claims 1e-6 m.
  double followed = 0;
  std::map<std::string, Tally> of;  // relation
};

// Scenes with the seeds first, first + 1, ... of a generator.
Tallies compare(const MotionSource& run, const std::string& scenes, unsigned first, int count);

// A relation that is known not to hold for a run: in so many of the scenes that the tests take without a wish.
struct Fact {
  std::string run, scenes, relation;
  int least, most;
  std::string reason;
};

// Fails for each relation that a scene breaks, and for each fact that is no longer one. RIGOR_RELATIONS=100000 takes so
// many scenes in all, shared out among the rows of the tests, and RIGOR_RELATIONS_FROM other seeds.
void check(const MotionSource& run, const std::string& scenes, int count, const std::vector<Fact>& facts = {});

}  // namespace rigor::test
