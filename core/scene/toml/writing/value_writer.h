// A case file's text with another number in its scene; all else stays as it was written.
#pragma once

#include <string>

namespace rigor::inline scene {

// `path` names the value: scene.gravity[1], scene.spring[0].stiffness, scene.body.cube.mass (a row by its name or by
// its number from 0), scene.contact_default.friction. A missing key is added to its table. Throws InputError, with a
// near match, for an unknown path; the reader checks the value. The text must be that of a TOML file which has been
// read.
std::string with_value(const std::string& text, const std::string& path, const std::string& value);

}  // namespace rigor::inline scene
