// Data in a page: JSON in <script> elements that no browser runs.
#pragma once

#include <string>

#include "core/base/json_fwd.h"

namespace rigor::inline report {

inline constexpr const char *kResultsElement = "rigor-results", *kPlaybackElement = "rigor-playback",
                            *kSiteElement = "rigor-site", *kDivergenceElement = "rigor-divergence";

// The element with its line end. No "<" is left in the JSON that could end the element or begin a comment.
std::string data_element(const std::string& id, const Json& json);

// The page with one more element, before that of the results. Throws std::logic_error for a page without results.
std::string with_data_element(const std::string& page, const std::string& id, const Json& json);

// The JSON text of the first such element of a page; empty if there is none.
std::string data_of_element(const std::string& page, const std::string& id);

}  // namespace rigor::inline report
