// A scene from the text of a case file, called s.toml in messages.
#pragma once

#include <string>

#include "core/scene/toml/scene_reader.h"
#include "core/scene/toml/table_reader.h"

namespace rigor {

inline Scene scene_of(const std::string& text) {
  const TomlFile file = TomlFile::parse(text, "s.toml");
  return read_scene(file.root({"scene"}).at("scene"));
}

}  // namespace rigor
