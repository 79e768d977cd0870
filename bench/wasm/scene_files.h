// Scenes for engines of the npm registry, and how right these are in them.
#pragma once

#include <string>
#include <vector>

namespace rigor::bench {

// Writes DIR/scenes.json: the scenes of `bench/run --wasm`, and what each of these plug-ins reaches in each of them, or
// why it cannot. bench/wasm/compare.mjs then times them.
void write_scene_files(const std::string& dir, const std::vector<std::string>& plugins);

}  // namespace rigor::bench
