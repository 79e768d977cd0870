// The origin of truths, and their limits: a run made by the same code agrees with such a truth even if both are wrong.
#pragma once

#include <string>

#include "core/engine/run_name.h"
#include "core/scene/scene.h"

namespace rigor::inline truth {

// A row of the table in provenance.cpp, for a truth that is solved and no closed form.
struct Provenance {
  std::string truth;  // as truth.kind says
  std::string how;    // is made, and of which engines and methods it is independent
  // Whether the code that makes it makes this run of the scene too; null: of no run.
  bool (*is_made_like)(const RunName& run, const Scene& scene) = nullptr;
};

// "a closed form, independent of every engine and method", or the row's own words; empty for "none".
std::string provenance_of(const std::string& truth);

// Whether the code that makes this truth makes this run of the scene too.
bool is_made_by(const std::string& truth, const RunName& run, const Scene& scene);
// The same for the reference of ensembles. It is the core, with the contact that it gives a scene by itself
// (runner/ensemble.h).
bool is_made_like_ensembles(const RunName& run, const Scene& scene);

}  // namespace rigor::inline truth
