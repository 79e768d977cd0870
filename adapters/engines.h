// The table of engines: every simulator that Rigor can run.
#pragma once

#include <memory>
#include <vector>

#include "core/engine/engine.h"

namespace rigor {

using EngineTable = std::vector<std::unique_ptr<Engine>>;

const EngineTable& engines();  // alphabetical

std::vector<EngineInfo> infos_of(const EngineTable& table);
const Engine& find_engine(const EngineTable& table, const std::string& name);  // the name must be there

}  // namespace rigor
