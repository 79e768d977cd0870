// DART's global state: the constants of its constraints, which hold for the whole process, and its messages, which go
// to std::cerr and std::cout in colours. A world sets the constants for each of its steps, and restores the old values.
#pragma once

#include <sstream>
#include <string>

namespace rigor::inline adapters::dart_library {

struct Constants {
  double contact_erp, contact_speed, contact_cfm;  // share a step, m/s at most, share of the diagonal
  double loop_erp, loop_cfm;                       // of joints that close loops
};

Constants constants_in_force();
void set_constants(const Constants& constants);

class ForOneStep {
 public:
  explicit ForOneStep(const Constants& constants) : before_(constants_in_force()) { set_constants(constants); }
  ~ForOneStep() { set_constants(before_); }
  ForOneStep(const ForOneStep&) = delete;
  ForOneStep& operator=(const ForOneStep&) = delete;

 private:
  Constants before_;
};

// Captures the output to std::cerr and std::cout during its lifetime.
class Messages {
 public:
  Messages();
  ~Messages();
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;
  std::string first() const;  // the first line, without colours; empty if there is none

 private:
  std::ostringstream text_;
  std::streambuf *cerr_, *cout_;
};

}  // namespace rigor::inline adapters::dart_library
