// ODE as a process-wide library: started once, its messages caught.
#pragma once

#include <string>

namespace rigor::inline adapters::ode_library {

// Before any other call to ODE in this thread. Errors that ODE does not survive go to stderr before it aborts.
void start();

// ODE's messages in this thread since the last call ("LCP internal error …"); empty without messages.
std::string take_messages();

// Drops ODE's messages in this thread as long as it lives.
class WithoutMessages {
 public:
  WithoutMessages();
  ~WithoutMessages();
  WithoutMessages(const WithoutMessages&) = delete;
  WithoutMessages& operator=(const WithoutMessages&) = delete;
};

}  // namespace rigor::inline adapters::ode_library
