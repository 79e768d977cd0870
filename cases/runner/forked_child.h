// One child of the process pool: a process that does one job, the pipes for its messages and its output, and its end.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <string>

#include "cases/runner/platform/platform.h"
#include "cases/runner/process_pool.h"

namespace rigor::inline runner {

// Of a file, closed with it.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  void reset(int number) { close(), number_ = number; }
  void close();

 private:
  int number_;
};

class ForkedChild {
 public:
  ForkedChild(const Job& work, std::size_t index);  // starts it; throws std::system_error
  ~ForkedChild();                                   // kills it
  ForkedChild(const ForkedChild&) = delete;
  ForkedChild& operator=(const ForkedChild&) = delete;

  const std::size_t job;

  int messages_descriptor() const { return messages_.number(); }
  int words_descriptor() const { return words_.number(); }
  bool has_closed_its_pipes() const { return messages_.number() < 0 && words_.number() < 0; }
  // Reads the available data; hands over each whole message.
  void listen(const std::function<void(std::size_t job, const std::string& message)>& on_message);
  bool has_ended();
  bool is_late() const;
  void stop();
  JobEnd end() const;

 private:
  void take_frame(char kind, const std::string& text,
                  const std::function<void(std::size_t, const std::string&)>& on_message);

  Platform::Time::time_point begin_, last_heard_;
  double limit_;  // s
  pid_t pid_ = -1;
  int status_ = 0;
  Descriptor messages_, words_;
  std::string received_, spoken_, closing_text_;
  char closing_kind_ = 0;
  bool has_sent_ = false, timed_out_ = false;
};

}  // namespace rigor::inline runner
