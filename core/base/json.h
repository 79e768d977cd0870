// JSON by nlohmann's library, of which each reader and writer takes a compiler seconds: they are compiled in json.cpp,
// for all.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "core/base/json_fwd.h"

extern template class nlohmann::basic_json<nlohmann::ordered_map>;

namespace rigor {

// Throws Json::parse_error, which says where.
Json parse_json(std::string_view text);

// The same, with a discarded value (is_discarded()) where the text is no JSON.
Json parse_json_or_discard(std::string_view text);

}  // namespace rigor
