// The folder that a run writes to. Files grow in a hidden folder inside it and are renamed into place when all is done,
// so that whoever looks finds either the old outputs or the new ones.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rigor {

class OutputFolder {
 public:
  // Makes the folder. Throws InputError, before anything is simulated, if it cannot be written or if something that is
  // no file stands where one of `file_names` would.
  OutputFolder(const std::string& path, const std::vector<std::string>& file_names);
  ~OutputFolder();  // removes what has not been published
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  std::string trajectories() const { return (partial_ / "trajectories").string(); }  // where they grow
  void write(const std::string& file_name, const std::string& text);                 // not seen until published
  void publish();

 private:
  std::filesystem::path folder_, partial_;
};

}  // namespace rigor
