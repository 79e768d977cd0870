#include "cases/runner/journal/journal.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstdint>
#include <cstring>

#include "cases/runner/platform/platform.h"
#include "core/base/content_hash.h"

namespace rigor::inline runner {
namespace {

// Before each record; then its message and its path.
struct Head {
  std::uint64_t job, message, path, hash;
};

std::string title_of(const std::string& plan) { return fmt::format("rigor journal {:016x}\n", content_hash(plan)); }

}  // namespace

std::string framed(std::size_t job, const Journal::Record& record) {
  const std::string text = record.message + record.path;
  const Head head{job, record.message.size(), record.path.size(), content_hash(text)};
  return std::string(reinterpret_cast<const char*>(&head), sizeof head) + text;
}

bool take_record(const std::string& bytes, std::size_t& at, std::size_t& job, Journal::Record& record) {
  Head head;
  if (bytes.size() - at < sizeof head) return false;
  std::memcpy(&head, bytes.data() + at, sizeof head);
  const std::size_t left = bytes.size() - at - sizeof head;
  if (head.message > left || head.path > left - head.message) return false;
  const std::size_t begin = at + sizeof head;
  if (content_hash(bytes.substr(begin, head.message + head.path)) != head.hash) return false;
  job = head.job;
  record = {bytes.substr(begin, head.message), bytes.substr(begin + head.message, head.path)};
  at = begin + head.message + head.path;
  return true;
}

Journal::Journal(const std::string& file, const std::string& plan) {
  if (file.empty()) return;
  const std::string bytes = read_file(file).bytes, title = title_of(plan);
  std::size_t whole = 0;
  if (bytes.starts_with(title)) {
    whole = title.size();
    std::size_t job = 0;
    for (Record record; take_record(bytes, whole, job, record);) {
      record.message.empty() ? void(found_.erase(job)) : void(found_[job] = record);
    }
  }
  descriptor_ = the_platform().open(file, O_WRONLY | O_CREAT);
  // A failed write is ignored; the run is not affected.
  if (descriptor_ < 0) return;
  if (the_platform().truncate(descriptor_, whole) != 0) {
    the_platform().close(descriptor_), descriptor_ = -1;
    return;
  }
  if (whole == 0) append(title);
}

Journal::~Journal() {
  if (descriptor_ >= 0) the_platform().close(descriptor_);
}

void Journal::forget_if(const std::function<bool(const Record&)>& is_wrong) {
  std::erase_if(found_, [&](const auto& one) {
    if (!is_wrong(one.second)) return false;
    add(one.first, {});  // for the next run, too: its trajectory may be there again by then, of another try
    return true;
  });
}

void Journal::append(const std::string& bytes) {
  for (std::size_t at = 0; descriptor_ >= 0 && at < bytes.size();) {
    const ssize_t count = the_platform().write(descriptor_, bytes.data() + at, bytes.size() - at);
    if (count > 0) at += static_cast<std::size_t>(count);
    if (count < 0 && errno != EINTR) the_platform().close(descriptor_), descriptor_ = -1;
  }
}

void Journal::add(std::size_t job, const Record& record) { append(framed(job, record)); }

}  // namespace rigor::inline runner
