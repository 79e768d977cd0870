// The site grows in a hidden folder beside its own, and both are exchanged when it is whole.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>

#include "cases/report/site/site.h"
#include "core/base/error.h"

namespace rigor::inline report {
namespace {

namespace fs = std::filesystem;

// What the site may stand for: an empty folder, or an older site.
void check_what_is_there(const fs::path& folder, const std::vector<SiteFile>& files) {
  if (!fs::exists(fs::symlink_status(folder))) return;
  if (!fs::is_directory(folder)) throw InputError("it is no folder");
  std::set<std::string> own;
  for (const SiteFile& file : files) own.insert(file.address.substr(0, file.address.find('/')));
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (!own.contains(entry.path().filename().string()))
      throw InputError(fmt::format("'{}' in it is not of a site, which replaces the whole folder; name another folder",
                                   entry.path().filename().string()));
  }
}

void write_text(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(errno == 0 ? "it could not be written" : std::strerror(errno));
}

// Held until the process that writes ends, however it ends.
class GrowingSite {
 public:
  explicit GrowingSite(const fs::path& folder)
      : path_(folder.parent_path() / ("." + folder.filename().string() + ".partial")) {
    fs::create_directories(path_);
    lock_ = open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ < 0 || flock(lock_, LOCK_EX | LOCK_NB) != 0) {
      if (lock_ >= 0) close(lock_);
      throw InputError("another process is writing to it");
    }
    clear();
  }
  ~GrowingSite() {
    std::error_code no_matter;
    if (!is_in_place_) fs::remove_all(path_, no_matter);
    close(lock_);
  }
  GrowingSite(const GrowingSite&) = delete;
  GrowingSite& operator=(const GrowingSite&) = delete;

  const fs::path& path() const { return path_; }

  // Where the file system cannot exchange two folders, the old one goes before the new one comes.
  void put_into_place(const fs::path& folder) {
    if (!fs::exists(folder)) return fs::rename(path_, folder), void(is_in_place_ = true);
    if (renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, folder.c_str(), RENAME_EXCHANGE) == 0) return;  // the old one goes
    const fs::path old = path_.string() + ".old";
    fs::remove_all(old), fs::rename(folder, old), fs::rename(path_, folder);
    is_in_place_ = true;
    fs::remove_all(old);
  }

 private:
  void clear() const {
    for (const fs::directory_entry& entry : fs::directory_iterator(path_)) fs::remove_all(entry.path());
  }

  fs::path path_;
  int lock_ = -1;
  bool is_in_place_ = false;  // nothing is left to remove
};

}  // namespace

void write_site(const std::string& folder, const std::vector<SiteFile>& files) {
  try {
    if (folder.empty()) throw InputError("the name is empty");
    fs::path place = fs::absolute(folder).lexically_normal();
    if (!place.has_filename()) place = place.parent_path();
    check_what_is_there(place, files);
    GrowingSite growing(place);
    for (const SiteFile& file : files) write_text(growing.path() / file.address, file.text);
    growing.put_into_place(place);
  } catch (const std::exception& error) {
    const auto* of_files = dynamic_cast<const fs::filesystem_error*>(&error);
    throw InputError(fmt::format("--out {}: the site cannot be written: {}", folder,
                                 of_files ? of_files->code().message() : error.what()));
  }
}

}  // namespace rigor::inline report
