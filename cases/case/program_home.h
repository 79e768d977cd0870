// The folder of the program's files: the suite and the data about engines.
#pragma once

#include <string>

namespace rigor::inline cases {

// The folder `inside` of, in this order: the one that the variable RIGOR_HOME names; ../share/rigor beside the
// program's own folder, where an install has put it; else `as_built`, in the sources. Throws InputError where
// RIGOR_HOME is set and has no such folder.
std::string home_folder(const std::string& inside, const std::string& as_built);

}  // namespace rigor::inline cases
