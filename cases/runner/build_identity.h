// Which build this is: what one build has computed, another does not go on from.
#pragma once

#include <string>

namespace rigor {

// A hash of the program's own bytes and of those of every shared library it is linked with, engines among them. Read
// once.
const std::string& build_identity();

}  // namespace rigor
