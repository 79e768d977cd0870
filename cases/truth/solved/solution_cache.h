// Reference solutions, kept from one run to the next: a file for each content of a scene, duration and sources of
// the solver, in $RIGOR_CACHE_DIR, else $XDG_CACHE_HOME/rigor, else ~/.cache/rigor. Nothing depends on it: what cannot
// be read, or is not what was written, is as if it were not there, and what cannot be written is not kept. An empty
// RIGOR_CACHE_DIR switches it off.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "cases/truth/solved/reference_solver.h"

namespace rigor {

// All that a reference solution depends on, bit by bit: every number of the scene that its motion has to do with, the
// duration, and what it is made by: this program's sources and compiler (fingerprints.cmake), unless another is given.
// Names, shapes and contacts are not among it.
std::string reference_content(const Scene& scene, double duration);
std::string reference_content(const Scene& scene, double duration, const std::string& made_by);
// Likewise of a solution by events, with shapes and contacts.
std::string events_content(const Scene& scene, double duration);
std::string events_content(const Scene& scene, double duration, const std::string& made_by);

std::optional<ReferenceSolution> kept_solution(const std::string& content);
void keep_solution(const std::string& content, const ReferenceSolution& solution);
// The one that is kept, or else the one that `solve` makes, from now on kept.
ReferenceSolution kept_or_solved(const std::string& content, const std::function<ReferenceSolution()>& solve);

}  // namespace rigor
