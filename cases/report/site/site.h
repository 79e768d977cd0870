// A static web site of results: index.html, a page for each engine, case and metric, badges, and the same as JSON.
#pragma once

#include <string>
#include <vector>

namespace rigor::inline report {

struct SiteFile {
  std::string address;  // below the site's folder
  std::string text;
};

// The inputs are folders that `rigor run` or `rigor gate` wrote, from the oldest to the newest, and files of `rigor
// history`. `notes` says what of them is left out. Throws InputError for other input.
std::vector<SiteFile> site_files(const std::vector<std::string>& inputs, std::vector<std::string>& notes);

// Writes the site as a whole: a failed write leaves the folder as it was. Throws InputError if the folder holds files
// that are not of a site, or cannot be written.
void write_site(const std::string& folder, const std::vector<SiteFile>& files);

}  // namespace rigor::inline report
