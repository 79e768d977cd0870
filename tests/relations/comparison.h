// Compares the motion of generated scenes with those of related scenes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/relations/relations.h"
#include "tests/relations/runs.h"

namespace rigor::test {

// The result of one relation over many scenes.
struct Tally {
  int scenes = 0, broken = 0;
  double largest = 0;  // m and rad apart
  double nearest = 0;  // the largest share of its bound
  std::string worst;   // the scene in which that is, with its seed
};

struct Tallies {
  int scenes = 0, asked = 0, supported = 0;  // asked: those that the run declares that it supports
  // The sum over scenes of the share of time that is compared. It ends where the motion becomes chaotic, where the run
  // gives up, or where a truth claims more than 1e-6 m.
  double followed = 0;
  std::map<std::string, Tally> of;  // relation
};

// Scenes with the seeds first, first + 1, ... of a generator.
Tallies compare(const MotionSource& run, const std::string& scenes, unsigned first, int count);

// A relation that a run is known to break, and in how many of the scenes that the tests take by default.
struct Fact {
  std::string run, scenes, relation;
  int least, most;
  std::string reason;
};

// Fails for each relation that a scene breaks, and for each fact that is no longer one. RIGOR_RELATIONS=100000 takes so
// many scenes in all, shared out among the rows of the tests. RIGOR_RELATIONS_FROM sets the first seed. Facts are about
// the default scenes and are not counted with these variables.
void check(const MotionSource& run, const std::string& scenes, int count, const std::vector<Fact>& facts = {});

}  // namespace rigor::test
