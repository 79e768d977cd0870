#include "core/base/json.h"

#include <regex>

#include "core/base/json_words.h"

template nlohmann::basic_json<nlohmann::ordered_map>::basic_json(const basic_json&);
template nlohmann::basic_json<nlohmann::ordered_map>::basic_json(initializer_list_t, bool, value_t);
template void nlohmann::basic_json<nlohmann::ordered_map>::json_value::destroy(value_t);
template std::string nlohmann::basic_json<nlohmann::ordered_map>::dump(int, char, bool, error_handler_t) const;

namespace rigor {

std::string in_words(const std::exception& error) {
  const std::string text = error.what();
  if (!dynamic_cast<const Json::exception*>(&error)) return text;
  static const std::regex place("at line ([0-9]+), column ([0-9]+)"), key("key ('.*') not found"),
      head("^\\[json\\.exception[^\\]]*\\] ");
  std::smatch found;
  if (std::regex_search(text, found, place))
    return "line " + found.str(1) + ", column " + found.str(2) + ": is not JSON";
  if (std::regex_search(text, found, key)) return "there is no key " + found.str(1);
  return std::regex_replace(text, head, "");
}

Json parse_json(std::string_view text) { return Json::parse(text); }

Json parse_json_or_discard(std::string_view text) { return Json::parse(text, nullptr, false); }

}  // namespace rigor
