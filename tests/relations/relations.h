// The table of relations. A relation turns one scene into another whose motion follows from that of the first.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cases/truth/solved/events/equivalent_scene.h"
#include "core/engine/body_table.h"
#include "tests/relations/random.h"

namespace rigor::test {

// A scene and its motion, sampled at equal steps from t = 0.
struct Original {
  const Scene& scene;
  const std::vector<BodyTable>& states;
  double step;  // s

  std::size_t last() const { return states.size() - 1; }
};

struct Related {
  Scene scene;
  Equivalence how = {};                                     // units, mirror and turn
  Vec3 shift = Vec3::Zero(), velocity = Vec3::Zero();       // of the original's origin, before `how`
  std::vector<std::size_t> rows = {};                       // of the original's bodies; empty: the same
  std::optional<std::pair<std::size_t, Vec3>> offset = {};  // m: where an original body's centre is in the related B
  std::size_t first = 0;                                    // the original's sample with which it begins
  bool runs_back = false;                                   // in time

  // The related motion's sample for the original's k-th.
  std::size_t sample(std::size_t k) const { return runs_back ? first - k : k - first; }
  bool covers(std::size_t k) const { return runs_back ? k <= first : k >= first; }
  std::size_t steps(const Original& original) const { return runs_back ? first : original.last() - first; }
  // The original's poses for the related ones, at the original's time t.
  BodyTable original(BodyColumns related, double t) const;
};

// What a relation leaves as it is.
enum class Keeps {
  bits,       // each floating-point operation, but for powers of two
  steps,      // the discrete motion, but for rounding
  stretches,  // the same, between events. Thresholds may change: the scene's own units have other values.
  motion,     // the motion alone
};

struct Relation {
  std::string name;
  Keeps keeps;
  // Nothing where the relation does not apply to the scene.
  std::function<std::optional<Related>(const Original& original, Random& random)> of;
};

const std::vector<Relation>& relations();

// A scene that begins with the state of another at its time t. Nothing if the state does not tell what follows.
std::optional<Scene> restarted(const Scene& scene, const std::vector<BodyTable>& until_then, double t);
// A scene that moves back from that state to the start. Nothing if energy is lost.
std::optional<Scene> reversed(const Scene& scene, const std::vector<BodyTable>& until_then, double t);

}  // namespace rigor::test
