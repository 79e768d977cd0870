// The folder that a run writes to. Files grow in a hidden folder inside it and are renamed into place when all is done,
// so that whoever looks finds either the old outputs or the new ones. A run that is stopped leaves the hidden folder,
// from which another can go on.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rigor {

class OutputFolder {
 public:
  // Makes the folder. Throws InputError, before anything is simulated, if it cannot be written or if something that is
  // no file stands where one of `file_names` would.
  // `resume`: takes over what a run that is no longer there left, if one did.
  OutputFolder(const std::string& path, const std::vector<std::string>& file_names, bool resume = false);
  ~OutputFolder();  // removes what has not been published
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  std::string journals() const { return (partial_ / "journals").string(); }
  std::string trajectories() const { return (partial_ / "trajectories").string(); }  // where they grow
  void write(const std::string& file_name, const std::string& text);                 // not seen until published
  // The folder of trajectories becomes the new one, with these files and no others; what stood there that is no
  // trajectory of Rigor's stays. Works on if this process is killed meanwhile.
  void publish(const std::vector<std::string>& trajectories);
  void keep() { is_kept_ = true; }  // for another run to go on from

 private:
  void rename_into_place() const;

  std::filesystem::path folder_, partial_;
  bool is_kept_ = false;
};

}  // namespace rigor
