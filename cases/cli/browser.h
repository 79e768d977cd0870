// The desktop's browser.
#pragma once

#include <string>

namespace rigor::inline cli {

// Shows a file in the browser, by xdg-open. Returns why it did not open; empty if it did.
std::string why_not_shown(const std::string& file);

}  // namespace rigor::inline cli
