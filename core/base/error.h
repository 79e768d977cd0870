// Bad input throws one type. Its text is a whole sentence for the person who gave the input: where it stands, what was
// found, what is allowed. What an engine cannot do, and a simulation that blows up, are results and not errors.
#pragma once

#include <stdexcept>
#include <string>

namespace rigor {

class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace rigor
