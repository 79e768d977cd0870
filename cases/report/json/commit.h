// The commit from which the program was built.
#pragma once

#include <string>

namespace rigor::inline report {

// The text of `git describe`, with "-dirty" if files differ from it; "" without a checkout.
std::string commit();

}  // namespace rigor::inline report
