// ODE as a process-wide library: started once, its messages caught.
#pragma once

#include <string>

namespace rigor::ode_library {

// Before any other call to ODE in this thread. Errors that ODE does not survive go to stderr before it aborts.
void start();

// What ODE has said in this thread since the last call ("LCP internal error …"); empty if nothing.
std::string take_messages();

}  // namespace rigor::ode_library
