// The results of a case so far, in a file that only grows. A stopped run continues from it. Incomplete entries and
// those of another plan are ignored.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>

namespace rigor::inline runner {

class Journal {
 public:
  struct Record {
    std::string message;  // to the grid's process
    std::string path;     // see spread.h; empty for what leaves none
  };
  static constexpr std::size_t kTruth = static_cast<std::size_t>(-1);  // the job of the truth's own record

  // Reads the file if it belongs to the same plan, else starts a new one. An empty file name: nothing is kept.
  Journal(const std::string& file, const std::string& plan);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  const std::map<std::size_t, Record>& found() const { return found_; }  // by job
  void add(std::size_t job, const Record& record);
  // As if these had never been found, in later runs, too. A later record of the same job counts instead.
  void forget_if(const std::function<bool(const Record&)>& is_wrong);

 private:
  void append(const std::string& bytes);

  std::map<std::size_t, Record> found_;
  int descriptor_ = -1;
};

// A record as a journal holds it, and the one at `at`, which is moved behind it; false if there is no whole one.
std::string framed(std::size_t job, const Journal::Record& record);
bool take_record(const std::string& bytes, std::size_t& at, std::size_t& job, Journal::Record& record);

}  // namespace rigor::inline runner
