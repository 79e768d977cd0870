// Keeps reference solutions from one run to the next: one file for each content of a scene, duration and solver
// sources. The folder is $RIGOR_CACHE_DIR, else $XDG_CACHE_HOME/rigor, else ~/.cache/rigor. No result depends on the
// cache. A file that is unreadable or damaged counts as missing, and a failed write is ignored. An empty
// RIGOR_CACHE_DIR turns the cache off.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "cases/truth/solved/reference_solver.h"

namespace rigor::inline truth {

// All inputs of a reference solution, bit by bit: every number of the scene that affects its motion, the duration, and
// this program's sources and compiler (fingerprints.cmake), unless another maker is given. Names, shapes and contacts
// are not included.
std::string reference_content(const Scene& scene, double duration);
std::string reference_content(const Scene& scene, double duration, const std::string& made_by);
// Likewise of a solution by events, with shapes and contacts.
std::string events_content(const Scene& scene, double duration);
std::string events_content(const Scene& scene, double duration, const std::string& made_by);

std::optional<ReferenceSolution> kept_solution(const std::string& content);
void keep_solution(const std::string& content, const ReferenceSolution& solution);
// The one that is kept, or else the one that `solve` makes, from now on kept.
ReferenceSolution kept_or_solved(const std::string& content, const std::function<ReferenceSolution()>& solve);

}  // namespace rigor::inline truth
