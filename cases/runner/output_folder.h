// The output folder of a run. Files grow in a hidden folder inside it, which a lock reserves for this run. They are
// moved into place when all is done, so readers see either the old outputs or the new ones. A stopped run leaves the
// hidden folder, and another run can continue from it. If a run is stopped while it moves outputs into place, the next
// run of any kind completes this.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace rigor::inline runner {

class OutputFolder {
 public:
  // Makes the folder. Throws InputError, before any simulation or change, in three cases: it is not writable, another
  // run writes to it, or one of `file_names` exists and is no file. `resume`: continues from the files of a run that
  // has ended, if there are any.
  OutputFolder(const std::string& path, const std::vector<std::string>& file_names, bool resume = false);
  // Of a process that works for the one which has made the folder: says where things are, and changes nothing.
  static OutputFolder of_helper(const std::string& path) { return OutputFolder(path); }
  ~OutputFolder();  // removes unpublished files
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  std::string journals() const { return (partial_ / "journals").string(); }
  std::string trajectories() const { return (partial_ / "trajectories").string(); }  // where they grow
  // Path under which one of `file_names` may be written piece by piece; invisible until published.
  std::string growing(const std::string& file_name) const { return (staged_ / "reports" / file_name).string(); }
  // One of `file_names`; not seen until published. Throws std::runtime_error, with the reason, if it cannot be written.
  void write(const std::string& file_name, const std::string& text);
  // The folder of trajectories becomes the new one, with these files and no others; what stood there that is no
  // trajectory of Rigor's stays. Those of `file_names` that were not written are no longer there: they would be of
  // another run. Works on if this process is killed meanwhile.
  void publish(const std::vector<std::string>& trajectories);
  void publish_files();             // those alone; trajectories stay as they are
  void keep() { is_kept_ = true; }  // for another run to go on from

 private:
  explicit OutputFolder(const std::string& path);
  void put_in_place(ino_t of_trajectories);
  void stage_trajectories(const std::vector<std::string>& trajectories) const;

  std::filesystem::path folder_, partial_, staged_;
  std::vector<std::string> file_names_;
  int lock_ = -1;
  bool is_kept_ = false, is_helper_ = false;
};

struct OutputFile {
  std::string name;
  std::function<std::string()> text;
};

// Writes each file by itself, then moves all that could be written into place, with these trajectories. Returns a
// sentence for each that could not. The folder then keeps the results if --resume can continue from them. Without any
// file, no output is changed.
std::vector<std::string> faults_of_writing(OutputFolder& folder, const std::vector<OutputFile>& files,
                                           const std::vector<std::string>& trajectories, bool can_resume);

}  // namespace rigor::inline runner
