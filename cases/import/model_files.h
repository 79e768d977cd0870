// The files that a model may name: those in its own folder and below, after links are resolved.
#pragma once

#include <string>

#include "cases/import/xml.h"

namespace rigor {

// Refuses, at the element that names it, a path that leaves the folder of `model`. A URI of packages, "package://" or
// "model://", names no path of this machine and is never looked up.
void check_stays_in_folder(const std::string& path, const XmlElement& element, const std::string& model);

// The same of every file that MuJoCo would read for the model, those that it includes among them; and that they are not
// larger than a model may be.
void check_files_of_mjcf(const XmlFile& model);

}  // namespace rigor
