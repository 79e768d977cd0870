// The page's script and style sheet, built from page/. The build tree contains a source with these two lines.
#pragma once

#include <string_view>

namespace rigor::inline report {

extern const std::string_view kPageScript;
extern const std::string_view kPageScriptHash;  // as a content security policy names it
extern const std::string_view kPageStyle;
extern const std::string_view kSiteStyle;     // of the pages of `rigor site` that run no script
extern const std::string_view kPageLicences;  // of the script's content

}  // namespace rigor::inline report
