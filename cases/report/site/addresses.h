// The permanent addresses of the site. A name of other people's files becomes a safe file name: letters, digits, "-",
// "_" and inner "." stay, and any other byte is "~" and two hexadecimal digits. Two names never share a file.
#pragma once

#include <string>

namespace rigor::inline report {

std::string safe_name(const std::string& name);     // of one part; a long one is cut and ends in its hash
std::string safe_path(const std::string& case_id);  // of each part between the slashes

std::string engine_page_address(const std::string& engine);  // "engines/ode.html"
std::string case_page_address(const std::string& case_id);   // "cases/springs/fixed-spring.html"
std::string metric_page_address(const std::string& metric);  // "metrics/position_error.html"
std::string badge_address(const std::string& run);           // "badge/ode.svg"
std::string engine_data_address(const std::string& engine);  // "api/engines/ode.json"
std::string case_data_address(const std::string& case_id);   // "api/cases/springs/fixed-spring.json"

// From a file at this address back to the site's folder: "../../".
std::string back_to_root(const std::string& address);

}  // namespace rigor::inline report
