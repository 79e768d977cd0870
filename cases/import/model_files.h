// A model may name files in its own folder and below. Symbolic links are followed before the check.
#pragma once

#include <string>

#include "cases/import/xml.h"

namespace rigor {

// Refuses, at the element that names it, a path that leaves the folder of `model`. A URI of packages, "package://" or
// "model://", names no path of this machine and is never looked up.
void check_stays_in_folder(const std::string& path, const XmlElement& element, const std::string& model);

// Does the same for every file that MuJoCo would read for the model, included files too. Also checks their size.
void check_files_of_mjcf(const XmlFile& model);

}  // namespace rigor
