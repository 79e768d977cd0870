// results.json without what is measured anew each run and what follows from it, such as the cheapest run.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace rigor {

inline nlohmann::json without_timings(const nlohmann::json& json) {
  static const std::set<std::string> timings = {"cpu_seconds", "wall_seconds", "cost",          "recommendation",
                                                "findings",    "explanations", "work_precision"};
  if (!json.is_structured()) return json;
  nlohmann::json out = json.is_array() ? nlohmann::json::array() : nlohmann::json::object();
  for (const auto& [key, value] : json.items()) {
    if (json.is_array()) out.push_back(without_timings(value));
    if (json.is_object() && !timings.contains(key)) out[key] = without_timings(value);
  }
  return out;
}

}  // namespace rigor
