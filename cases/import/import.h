// Reads robots' files as scenes. URDF and SDF have readers of our own, which name unknown elements. MJCF is parsed by
// MuJoCo. No file outside the model's folder is read, but meshes of a package that holds the model; and nothing from
// the network.
#pragma once

#include <string>
#include <vector>

#include "cases/import/import_options.h"
#include "core/scene/left_out.h"
#include "core/scene/scene.h"

namespace rigor::inline imports {

// By the ending: .urdf, .sdf, .mjcf, .xml or .xacro. The root of the file decides which format it is.
bool is_model_file(const std::string& path);

struct Import {
  std::string title, source;  // of a case
  Scene scene;
  std::vector<Loss> losses;  // what the scene does not have, by kind, and what was assumed
};

// Throws InputError, "file:line: what". Losses do not throw: see refuse_losses().
Import import_model(const std::string& path, const ImportOptions& options = {});

// Throws InputError if physics is lost and not accepted. The text has a line for each kind.
void refuse_losses(const Import& import, const std::string& path, const ImportOptions& options);

// Of the whole import: the losses of physics, what was assumed, and in one line what changes no motion. Each begins
// with two spaces, but the lines that begin a list.
std::vector<std::string> lines_of(const std::vector<Loss>& losses);

// A robot runs for 2 s by default, against the truth 'reference' where nothing can touch.
inline constexpr double kModelDuration = 2;  // s
inline constexpr const char* kModelSteps[] = {"1/30", "1/240", "1/1000"};
std::string truth_of_model(const Scene& scene);

// The import as a case file.
std::string case_text_of(const Import& import);

// The name of a body that falls without end, because no joint or spring holds it and nothing that stands still can be
// touched. Empty if there is none.
std::string falls_freely(const Scene& scene);

}  // namespace rigor::inline imports
