// The page's script and style sheet, as the build made them from page/: a source of these two lies in the build tree.
#pragma once

#include <string_view>

namespace rigor {

extern const std::string_view kPageScript;
extern const std::string_view kPageScriptHash;  // as a content security policy names it
extern const std::string_view kPageStyle;
extern const std::string_view kPageLicences;  // of what the script contains

}  // namespace rigor
