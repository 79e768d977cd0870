// Selects runs by their properties, so that gates need not name every method, and new methods are judged at once:
// "core:*", "ode*", "@stock", "symplectic", "order>=4 !adaptive", "core:*,contact=event".
#pragma once

#include <string>
#include <vector>

#include "core/engine/run_name.h"

namespace rigor::inline cases {

// Every method of the in-house core but the twins of other engines, and every other engine on both tracks.
std::vector<RunName> default_runs(const std::vector<EngineInfo>& engines);

// Whether the text is a selector; otherwise it is the name of a run.
bool is_run_selector(const std::string& text);

// The names of the default runs that meet every word of a selector, options that it spells added to each:
//   core:*  ode*  *@stock           a name, in which * stands for any letters; of either track unless it says one
//   @stock  @matched                a track
//   order>=4                        of the method as declared; also >, <=, <, =
//   symplectic  symmetric  adaptive a property of the method
//   twin                            the core repeats its scheme, to explain its error
//   !WORD                           not that
// Throws InputError for an unknown word, and for a selector that matches no run.
std::vector<std::string> selected_runs(const std::string& selector, const std::vector<EngineInfo>& engines);

}  // namespace rigor::inline cases
