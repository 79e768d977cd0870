// A command as a child process that answers each line with one line. The caller always gets an answer or an
// EngineFailure, within the time limit and in bounded memory. The child has its own process group, which is killed at
// the end, and dies with the process that started it.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>

namespace rigor::inline adapters {

class ChildProcess {
 public:
  // `command` is a simple command, with words split and quoted as in a shell: /bin/sh -c "exec COMMAND". `limit` is in
  // seconds: for sleeping over each request, and for the CPU time of all requests together. Other load on the machine
  // thus does not decide. Each request also has ten times the limit by the clock. `log` is a descriptor for the child's
  // stderr, with the name in front; -1 for none.
  ChildProcess(std::string command, double limit, int log, std::string name);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // Sends the line, waits for one line, and returns it without its end. `request`: how a message calls it.
  std::string ask(const std::string& line, const std::string& request, std::size_t longest_answer);
  // The raw bytes that follow the last answer.
  void receive(char* into, std::size_t bytes, const std::string& request);
  double cpu_seconds() const;                        // of the child so far
  double looked_for() const { return looked_for_; }  // s of this process's CPU time, in looking whether it has answered
  bool is_ours() const;                              // false in a fork of the process that started it
  const std::string& name() const { return name_; }

 private:
  [[noreturn]] void become_the_child(int in, int out, int err, pid_t parent) const;
  void refuse_unasked(const std::string& request);
  // Until `done`: writes the rest of `out_`, reads into `in_`.
  template <typename Done>
  void exchange(const std::string& request, const Done& done);
  void send();
  void look_briefly();
  bool read_answer();  // false at its end
  void read_words();
  void pass_on(const std::string& words);
  void check_time(const std::string& request) const;
  [[noreturn]] void report_end(const std::string& request);
  std::string last_words() const;
  void close_pipes();

  std::string command_, name_;
  double limit_;
  int log_;
  pid_t pid_ = -1, owner_ = -1;
  int to_ = -1, from_ = -1, words_from_ = -1;
  std::string out_, in_, words_;
  std::size_t passed_on_ = 0;  // bytes
  double asleep_ = 0;          // s, since it was asked
  double looked_for_ = 0;
  std::chrono::steady_clock::time_point begin_, asked_;
};

}  // namespace rigor::inline adapters
