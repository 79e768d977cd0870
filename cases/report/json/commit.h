// Which commit the program was built from.
#pragma once

#include <string>

namespace rigor {

// As `git describe` says it, "-dirty" where files differ from it; "" where the sources were no checkout.
std::string commit();

}  // namespace rigor
