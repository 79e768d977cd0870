// Bad input throws this one type. The text is a whole sentence for the user: the place, what was found, what is
// allowed. Limits of an engine and a simulation that blows up are results, not errors.
#pragma once

#include <stdexcept>
#include <string>

namespace rigor {

class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace rigor
