// Selects runs by what they are, so that no gate names every method and a new one is judged the day it lands:
// "core:*", "ode*", "@stock", "symplectic", "order>=4 !adaptive", "core:*,contact=event".
#pragma once

#include <string>
#include <vector>

#include "core/engine/run_name.h"

namespace rigor {

// Every method of the in-house core but the twins of other engines, and every other engine on both tracks.
std::vector<RunName> default_runs(const std::vector<EngineInfo>& engines);

// Whether the text selects runs by what they are; if not, it is the name of one.
bool is_run_selector(const std::string& text);

// The names of the default runs that meet every word of a selector, options that it spells added to each:
//   core:*  ode*  *@stock           a name, in which * stands for any letters; of either track unless it says one
//   @stock  @matched                a track
//   order>=4                        of the method as declared; also >, <=, <, =
//   symplectic  symmetric  adaptive what the method is
//   twin                            the core repeats its scheme, to explain its error
//   !WORD                           not that
// Throws InputError for a word that is none of these, and for a selector that no run meets.
std::vector<std::string> selected_runs(const std::string& selector, const std::vector<EngineInfo>& engines);

}  // namespace rigor
