// The folder that a run writes to. Files grow in a hidden folder inside it, which a lock holds for this run alone, and
// are put into place when all is done, so that whoever looks finds either the old outputs or the new ones. A run that
// is stopped leaves the hidden folder, from which another can go on; one that is stopped while it puts the outputs into
// place leaves that for the next run to finish, whatever that run is about.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace rigor {

class OutputFolder {
 public:
  // Makes the folder. Throws InputError, before anything is simulated or changed, if it cannot be written, if another
  // run is writing to it, or if something that is no file stands where one of `file_names` would. `resume`: takes over
  // what a run that is no longer there left, if one did.
  OutputFolder(const std::string& path, const std::vector<std::string>& file_names, bool resume = false);
  // Of a process that works for the one which has made the folder: says where things are, and changes nothing.
  static OutputFolder of_helper(const std::string& path) { return OutputFolder(path); }
  ~OutputFolder();  // removes what has not been published
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  std::string journals() const { return (partial_ / "journals").string(); }
  std::string trajectories() const { return (partial_ / "trajectories").string(); }  // where they grow
  // Where one of `file_names` may be written bit by bit; not seen until published.
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

}  // namespace rigor
