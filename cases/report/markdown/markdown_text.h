// Text from other people's files on its way into Markdown.
#pragma once

#include <string>

namespace rigor::inline report {

// Nothing in it ends a table's cell, opens a tag, becomes a link or changes the type.
std::string plain(const std::string& text);

}  // namespace rigor::inline report
