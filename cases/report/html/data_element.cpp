#include "cases/report/html/data_element.h"

#include <stdexcept>

#include "cases/results/result_json.h"
#include "core/base/json.h"

namespace rigor::inline report {
namespace {

constexpr const char* kClosing = "</script>";

std::string opening(const std::string& id) { return "<script type=\"application/json\" id=\"" + id + "\">"; }

}  // namespace

std::string data_element(const std::string& id, const Json& json) {
  const std::string text = text_of(json, -1);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) c == '<' ? safe += "\\u003c" : safe += c;
  return opening(id) + safe + kClosing + "\n";
}

std::string with_data_element(const std::string& page, const std::string& id, const Json& json) {
  const std::size_t at = page.find(opening(kResultsElement));
  if (at == std::string::npos) throw std::logic_error("the page holds no results");
  return page.substr(0, at) + data_element(id, json) + page.substr(at);
}

std::string data_of_element(const std::string& page, const std::string& id) {
  const std::string tag = opening(id);
  const std::size_t at = page.find(tag);
  if (at == std::string::npos) return "";
  const std::size_t from = at + tag.size(), end = page.find(kClosing, from);
  return end == std::string::npos ? "" : page.substr(from, end - from);
}

}  // namespace rigor::inline report
