// What a mistyped word may have meant.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rigor {

// Returns the word of `known` nearest to `word` by edit distance (insert, delete, replace, swap of neighbours; case
// ignored). The distance may be at most a third of the word's length, and at least one edit is allowed.
std::optional<std::string> near_match(std::string_view word, const std::vector<std::string>& known);

// " (did you mean 'x'?)" or "", ready to append to a message.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

// "a, b, c": the known words in the given order, for a message that lists the allowed words.
std::string listed(const std::vector<std::string>& words);

}  // namespace rigor
