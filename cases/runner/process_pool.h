// Runs jobs in forked children, so that an abort, endless loop or memory corruption costs only that job. A child sends
// framed messages to its parent through a pipe. Its printed output is captured, and the last line kept. The parent
// stays single-threaded, since fork without exec is safe only then, and waits in poll. Children die with the parent.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace rigor::inline runner {

// The child's end of the pipe.
class Channel {
 public:
  explicit Channel(int descriptor) : descriptor_(descriptor) {}
  void send(const std::string& message) const { send_frame('m', message); }
  void send_frame(char kind, const std::string& text) const;

 private:
  int descriptor_;
};

struct Job {
  std::function<void(const Channel&)> work;  // runs in the child
  double limit;  // s, CPU time until its first message; after that it ends only where it falls silent for long
};

// finished: `work` returned. refused: it threw InputError. threw: another exception. killed: by a signal. exited: the
// child called exit() without a message. timed_out: no message within the limit, or no more of them.
enum class Ending { finished, refused, threw, killed, exited, timed_out };

struct JobEnd {
  Ending how = Ending::exited;
  int code = 0;            // the signal, or the exit code
  std::string text;        // the text of the exception
  std::string last_words;  // the last line the child printed
  double seconds = 0;      // wall time from its start to its end
};

// "killed by SIGABRT (abort); its last words: ...", for every end except `finished`.
std::string sentence_of(const JobEnd& end, double limit);

// SIGINT, SIGTERM or SIGHUP arrived while jobs ran; the children are gone.
struct Interrupted {
  int signal;
};

// The source of jobs, one by one, as children become free.
class JobFeed {
 public:
  struct Numbered {
    std::size_t number;  // by which on_message and on_end know it
    Job job;
  };
  virtual ~JobFeed() = default;
  virtual bool is_over() = 0;                      // no further job will come; asked at every turn
  virtual std::optional<Numbered> next() = 0;      // empty: no job at present
  virtual int longest_wait() const { return 50; }  // ms, until it wants to be asked again
};

// Called at every turn of run_jobs, some twenty times a second, in the process that has set it and not in its children.
// An empty function stops the calls.
void set_heartbeat(std::function<void()> heartbeat);

// At most `at_once` children at a time, started in order. Throws Interrupted. on_end is called once for every job.
void run_jobs(JobFeed& feed, int at_once,
              const std::function<void(std::size_t job, const std::string& message)>& on_message,
              const std::function<void(std::size_t job, const JobEnd& end)>& on_end);
void run_jobs(const std::vector<Job>& jobs, int at_once,
              const std::function<void(std::size_t job, const std::string& message)>& on_message,
              const std::function<void(std::size_t job, const JobEnd& end)>& on_end);

}  // namespace rigor::inline runner
