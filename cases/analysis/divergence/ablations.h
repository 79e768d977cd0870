// Scenes without one part: a contact, a limit, a drive, a joint. If the one-step difference of two engines vanishes
// with the part, it enters there.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/engine/body_table.h"
#include "core/scene/scene.h"

namespace rigor::inline analysis {

struct Ablation {
  std::string what;    // "the contact of 'ball' and 'ground'"
  std::string detail;  // what happens there, with its numbers: "begins: the gap goes from 1e-3 m to -2e-4 m"; or ""
  // If two parts explain a difference equally, the one with the smaller rank is named: friction before its contact.
  int rank = 0;
  // Without a joint a body is cut off from differences that enter elsewhere. It explains a difference only if that of
  // all bodies vanishes.
  bool transmits = false;
  // Without gravity or a joint nothing loads the contacts and limits near it, so it explains what they do, too.
  bool is_general = false;
  std::shared_ptr<const Scene> scene;
};

// One step from `before` to `after`, of `seconds`.
struct AblatedStep {
  const Scene& scene;  // which begins in `before`
  std::vector<BodyState> before, after;
  double seconds = 0;
  int body = 0;  // whose difference is explained; parts near it come first
};

// At most `most`.
std::vector<Ablation> ablations_of(const AblatedStep& step, std::size_t most);

}  // namespace rigor::inline analysis
