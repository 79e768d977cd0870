#include "adapters/mujoco/mujoco_library.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <mutex>
#include <new>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"

namespace rigor::inline adapters::mujoco_library {
namespace {

thread_local std::string warnings;

void keep_warning(const char* text) {
  if (!warnings.empty()) warnings += "; ";
  warnings += text;
}

[[noreturn]] void throw_error(const char* text) { throw std::runtime_error(fmt::format("MuJoCo: {}", text)); }

// MuJoCo's file system in memory, some 2 MB.
class Files {
 public:
  Files() : vfs_(std::make_unique<mjVFS>()) { mj_defaultVFS(vfs_.get()); }
  ~Files() { mj_deleteVFS(vfs_.get()); }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;

  void add(const char* name, const std::string& text) {
    if (mj_makeEmptyFileVFS(vfs_.get(), name, static_cast<int>(text.size())) != 0)
      throw std::runtime_error("MuJoCo takes no file of this size");
    std::memcpy(vfs_->filedata[mj_findFileVFS(vfs_.get(), name)], text.data(), text.size());
  }
  const mjVFS* get() const { return vfs_.get(); }

 private:
  std::unique_ptr<mjVFS> vfs_;
};

// "XML Error: ... Element 'geom', line 5, column -1", or of its compiler "id = 0, line = 5": the line goes where lines
// go.
[[noreturn]] void refuse(const std::string& path, std::string text) {
  if (text.find("Could not allocate memory") != std::string::npos) throw std::bad_alloc();
  constexpr const char* kLine = "line ";
  const std::size_t at = text.find(kLine),
                    first = at == std::string::npos ? at : text.find_first_not_of("= ", at + std::string(kLine).size());
  const std::size_t end =
      first == std::string::npos ? first : std::min(text.find_first_not_of("0123456789", first), text.size());
  const std::string number = end == std::string::npos || end == first ? "1" : text.substr(first, end - first);
  for (char& c : text) c = c == '\n' ? ' ' : c;
  throw InputError(
      fmt::format("{}:{}: MuJoCo refuses the model: {}", path, number, text.substr(0, text.find_last_not_of(' ') + 1)));
}

}  // namespace

void start() {
  static std::once_flag once;
  std::call_once(once, [] { mju_user_warning = keep_warning, mju_user_error = throw_error; });
}

std::string take_warnings() { return std::exchange(warnings, ""); }

Model compile(const std::string& mjcf) {
  constexpr const char* kName = "scene.xml";
  Files files;
  files.add(kName, mjcf);
  std::array<char, 1000> error{};
  Model model(mj_loadXML(kName, files.get(), error.data(), static_cast<int>(error.size())));
  if (!model) throw InputError(fmt::format("MuJoCo refuses the scene: {}", error.data()));
  return model;
}

Model read_file(const std::string& path) {
  start();
  std::array<char, 1000> error{};
  Model model;
  try {
    model.reset(mj_loadXML(path.c_str(), nullptr, error.data(), static_cast<int>(error.size())));
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& failure) {  // thrown by the handler of its errors
    refuse(path, failure.what());
  }
  if (!model) refuse(path, error.data());
  return model;
}

}  // namespace rigor::inline adapters::mujoco_library
