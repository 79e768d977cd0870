#include "cases/report/site/addresses.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/content_hash.h"

namespace rigor::inline report {
namespace {

constexpr std::size_t kLongestName = 150;  // bytes; file systems take 255

bool stays_in_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
}

}  // namespace

std::string safe_name(const std::string& name) {
  if (name.empty()) return "~";
  std::string safe;
  for (const char c : name) {
    const bool is_hidden = c == '.' && safe.empty();
    safe += stays_in_name(c) && !is_hidden ? std::string(1, c) : fmt::format("~{:02X}", static_cast<unsigned char>(c));
  }
  if (safe.size() <= kLongestName) return safe;
  return fmt::format("{}~~{:016x}", safe.substr(0, kLongestName - 20), content_hash(name));
}

// A folder has no ".", so that it is never the file of a case.
std::string safe_path(const std::string& case_id) {
  std::string path;
  for (std::size_t from = 0;;) {
    const std::size_t slash = case_id.find('/', from);
    const std::string part = safe_name(case_id.substr(from, slash - from));
    if (slash == std::string::npos) return path + part;
    for (const char c : part) c == '.' ? path += "~2E" : path += c;
    path += '/', from = slash + 1;
  }
}

std::string engine_page_address(const std::string& engine) { return "engines/" + safe_name(engine) + ".html"; }
std::string case_page_address(const std::string& case_id) { return "cases/" + safe_path(case_id) + ".html"; }
std::string metric_page_address(const std::string& metric) { return "metrics/" + safe_name(metric) + ".html"; }
std::string badge_address(const std::string& run) { return "badge/" + safe_name(run) + ".svg"; }
std::string engine_data_address(const std::string& engine) { return "api/engines/" + safe_name(engine) + ".json"; }
std::string case_data_address(const std::string& case_id) { return "api/cases/" + safe_path(case_id) + ".json"; }

std::string back_to_root(const std::string& address) {
  std::string back;
  for (auto n = std::count(address.begin(), address.end(), '/'); n > 0; --n) back += "../";
  return back;
}

}  // namespace rigor::inline report
