#include "core/base/json.h"

template nlohmann::ordered_json::basic_json(const nlohmann::ordered_json&);
template nlohmann::ordered_json::basic_json(initializer_list_t, bool, value_t);
template void nlohmann::ordered_json::json_value::destroy(value_t);
template std::string nlohmann::ordered_json::dump(int, char, bool, error_handler_t) const;

namespace rigor {

Json parse_json(std::string_view text) { return Json::parse(text); }

Json parse_json_or_discard(std::string_view text) { return Json::parse(text, nullptr, false); }

}  // namespace rigor
