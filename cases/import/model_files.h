// A model may name files in its own folder and below. Symbolic links are followed before the check.
#pragma once

#include <optional>
#include <string>

#include "adapters/common/compiled_mjcf.h"
#include "cases/import/xml.h"

namespace rigor::inline imports {

// Refuses, at the element that names it, a path that leaves the folder of `model`. A URI of packages, "package://" or
// "model://", names no path of this machine and is never looked up.
void check_stays_in_folder(const std::string& path, const XmlElement& element, const std::string& model);

// The path of a mesh that `element` names: inside the folder of `model`, or inside the folder of the package that
// "package://NAME/..." or "model://NAME/..." names, if that is a folder above the model. Nothing for a package that is
// not. Refuses a path that leads out of these folders, and a file that is not there.
std::optional<std::string> file_of_mesh(const std::string& path, const XmlElement& element, const std::string& model);

// Does the same as the first for every file that MuJoCo would read for the model, included files too. Also checks their
// size. Returns these files, and the place of each element with a name.
MjcfSource check_files_of_mjcf(const XmlFile& model);

}  // namespace rigor::inline imports
