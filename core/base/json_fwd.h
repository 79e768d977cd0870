#pragma once

#include <nlohmann/json_fwd.hpp>

namespace rigor {

using Json = nlohmann::ordered_json;  // keys keep the order in which they were written

}  // namespace rigor
