#include "cases/runner/forked_child.h"

#include <sys/wait.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <system_error>

#include "core/base/error.h"

namespace rigor::inline runner {
namespace {

// A limit is one of CPU time, so that no verdict depends on what else the machine does; a job that sleeps ends too,
// after so many times its limit by the clock.
constexpr double kWaits = 10;

// A job that has sent something may continue as long as it sends something from time to time. Its limit is this many
// times its own by the clock, twice the longest time of its children. A stopped job sends nothing.
constexpr double kSilence = 2 * kWaits;

// Appends the available data. Closes the descriptor at its end.
void drain(Descriptor& from, std::string& into) {
  char buffer[1 << 16];
  while (from.number() >= 0) {
    const ssize_t count = the_platform().read(from.number(), buffer, sizeof buffer);
    if (count > 0) into.append(buffer, count);
    if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) from.close();
    if (count < 0 && errno != EINTR) return;
  }
}

// Does the job and sends how it ended.
void do_and_tell(const Job& job, const Channel& channel) {
  try {
    job.work(channel);
    channel.send_frame('d', "");
  } catch (const InputError& error) {
    channel.send_frame('i', error.what());
  } catch (const std::exception& error) {
    channel.send_frame('e', error.what());
  } catch (const Interrupted& interruption) {  // a child that itself waits for children
    the_platform().die_of(interruption.signal);
  } catch (...) {
    channel.send_frame('e', "an exception of an unknown type");
  }
}

// The last line with something on it, its control characters blanked.
std::string last_line(std::string text) {
  constexpr std::size_t kLongest = 300;
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  text.erase(0, text.find_last_of('\n') + 1);
  if (text.size() > kLongest) text.resize(kLongest);
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text;
}

std::chrono::steady_clock::duration seconds(double s) {
  constexpr double kForever = 1e8;  // s; more would overflow the clock
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(std::min(s, kForever)));
}

}  // namespace

void Channel::send_frame(char kind, const std::string& text) const {
  const std::uint64_t length = text.size();
  std::string frame(1 + sizeof length, kind);
  std::memcpy(frame.data() + 1, &length, sizeof length);
  frame += text;
  for (std::size_t at = 0; at < frame.size();) {
    const ssize_t count = the_platform().write(descriptor_, frame.data() + at, frame.size() - at);
    if (count < 0 && errno != EINTR)
      throw std::system_error(errno, std::generic_category(), "sending a result to the parent process");
    if (count > 0) at += count;
  }
}

void Descriptor::close() {
  if (number_ >= 0) the_platform().close(number_);
  number_ = -1;
}

ForkedChild::ForkedChild(const Job& work, std::size_t index)
    : job(index), begin_(the_platform().now()), last_heard_(begin_), limit_(work.limit) {
  const Platform::Child child = the_platform().start([work](const Channel& channel) { do_and_tell(work, channel); });
  pid_ = child.process;
  messages_.reset(child.messages), words_.reset(child.words);
}

ForkedChild::~ForkedChild() {
  if (pid_ > 0) the_platform().kill_and_wait(pid_);
}

void ForkedChild::listen(const std::function<void(std::size_t, const std::string&)>& on_message) {
  constexpr std::size_t kWordsKept = 1 << 16;
  drain(words_, spoken_);
  if (spoken_.size() > kWordsKept) spoken_.erase(0, spoken_.size() - kWordsKept);
  drain(messages_, received_);
  std::size_t at = 0;
  std::uint64_t length = 0;
  while (received_.size() - at >= 1 + sizeof length) {
    std::memcpy(&length, received_.data() + at + 1, sizeof length);
    if (received_.size() - at - 1 - sizeof length < length) break;
    take_frame(received_[at], received_.substr(at + 1 + sizeof length, length), on_message);
    at += 1 + sizeof length + length;
  }
  received_.erase(0, at);
}

bool ForkedChild::has_ended() {
  const auto status = the_platform().status_of_ended(pid_);
  if (!status) return false;
  pid_ = -1;
  status_ = *status;
  return true;
}

bool ForkedChild::is_late() const {
  const Platform::Time::time_point now = the_platform().now();
  if (closing_kind_ || has_sent_) return now - last_heard_ > seconds(kSilence * limit_);
  return the_platform().cpu_seconds(pid_) > limit_ || now - begin_ > seconds(kWaits * limit_);
}

void ForkedChild::stop() {
  status_ = the_platform().kill_and_wait(pid_);
  pid_ = -1;
  timed_out_ = true;
}

JobEnd ForkedChild::end() const {
  JobEnd end;
  end.last_words = last_line(spoken_);
  end.text = closing_text_;
  end.seconds = std::chrono::duration<double>(the_platform().now() - begin_).count();
  if (closing_kind_) {
    end.how = closing_kind_ == 'd' ? Ending::finished : closing_kind_ == 'i' ? Ending::refused : Ending::threw;
  } else if (timed_out_) {
    end.how = Ending::timed_out;
  } else {
    end.how = WIFSIGNALED(status_) ? Ending::killed : Ending::exited;
    end.code = WIFSIGNALED(status_) ? WTERMSIG(status_) : WEXITSTATUS(status_);
  }
  return end;
}

void ForkedChild::take_frame(char kind, const std::string& text,
                             const std::function<void(std::size_t, const std::string&)>& on_message) {
  last_heard_ = the_platform().now();
  if (kind != 'm') {
    closing_kind_ = kind, closing_text_ = text;
  } else {
    has_sent_ = true;
    on_message(job, text);
  }
}

}  // namespace rigor::inline runner
