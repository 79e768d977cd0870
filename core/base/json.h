// JSON with nlohmann's library. Each reader and writer takes a compiler seconds, so json.cpp compiles the shared ones
// once.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "core/base/json_fwd.h"

extern template nlohmann::basic_json<nlohmann::ordered_map>::basic_json(const basic_json&);
extern template nlohmann::basic_json<nlohmann::ordered_map>::basic_json(initializer_list_t, bool, value_t);
extern template void nlohmann::basic_json<nlohmann::ordered_map>::json_value::destroy(value_t);
extern template std::string nlohmann::basic_json<nlohmann::ordered_map>::dump(int, char, bool, error_handler_t) const;

namespace rigor {

// Throws Json::parse_error, which says where.
Json parse_json(std::string_view text);

// The same, with a discarded value (is_discarded()) where the text is no JSON.
Json parse_json_or_discard(std::string_view text);

}  // namespace rigor
