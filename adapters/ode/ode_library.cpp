#include "adapters/ode/ode_library.h"

#include <ode/ode.h>

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace rigor::inline adapters::ode_library {
namespace {

thread_local std::string messages;
thread_local bool are_messages_dropped = false;

// The text that ODE's printf-like call would print.
std::string formatted(const char* format, va_list arguments) {
  char text[512];
  std::vsnprintf(text, sizeof text, format, arguments);
  return text;
}

void on_message(int, const char* format, va_list arguments) {
  if (are_messages_dropped || !messages.empty())
    return;  // the first one of a step says it; a broken pile would repeat it a thousand times
  messages = formatted(format, arguments);
}

// ODE's errors and failed debug checks may not return.
void on_fatal(int number, const char* format, va_list arguments) {
  std::fprintf(stderr, "ODE error %d: %s\n", number, formatted(format, arguments).c_str());
  std::abort();
}

}  // namespace

void start() {
  static const bool started = [] {
    dInitODE2(0);
    dSetMessageHandler(on_message);
    dSetErrorHandler(on_fatal);
    dSetDebugHandler(on_fatal);
    return true;
  }();
  static_cast<void>(started);
  thread_local const bool has_thread_data = dAllocateODEDataForThread(dAllocateMaskAll) != 0;
  static_cast<void>(has_thread_data);
}

std::string take_messages() { return std::exchange(messages, {}); }

WithoutMessages::WithoutMessages() { are_messages_dropped = true; }
WithoutMessages::~WithoutMessages() { are_messages_dropped = false; }

}  // namespace rigor::inline adapters::ode_library
