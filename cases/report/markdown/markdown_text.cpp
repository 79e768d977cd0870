#include "cases/report/markdown/markdown_text.h"

namespace rigor::inline report {

std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\n' || c == '\r') {
      out += ' ';
    } else if (c == '<') {
      out += "&lt;";
    } else {
      if (std::string("|`*_[]~\\").find(c) != std::string::npos) out += '\\';
      out += c;
    }
  }
  return out;
}

}  // namespace rigor::inline report
