// Errors of the JSON library in words of our own.
#pragma once

#include <exception>
#include <string>

namespace rigor {

// "line 3, column 7: is not JSON", "there is no key 'cells'", "type must be string, but is null". The text of any other
// exception stays as it is.
std::string in_words(const std::exception& error);

}  // namespace rigor
