// The files of a simulated machine.
#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "tests/cases/runner/platform/simulated_platform.h"
#include "tests/cases/runner/platform/simulated_process.h"

namespace rigor::test {
namespace {

[[noreturn]] void fail_with(int number, const std::filesystem::path& path) {
  throw std::filesystem::filesystem_error("simulated", path, std::error_code(number, std::generic_category()));
}

}  // namespace

std::shared_ptr<FileNode> SimulatedPlatform::find(std::string_view path) const {
  NodePtr node = root_;
  each_name(path, [&](std::string_view name) {
    if (!node) return;
    const auto found = node->names.find(name);
    node = node->is_folder && found != node->names.end() ? found->second : nullptr;
  });
  return node;
}

void SimulatedPlatform::put(const std::string& path, const std::string& bytes) {
  NodePtr node = root_;
  each_name(path, [&](std::string_view name) {
    NodePtr& below = node->names[std::string(name)];
    if (!below) below = std::make_shared<FileNode>(), below->is_folder = true, below->inode = ++last_inode_;
    node = below;
  });
  node->is_folder = false, node->bytes = bytes;
}

SimulatedPlatform::NodePtr SimulatedPlatform::folder_of(const Path& path, std::string& name) const {
  name = path.filename().string();
  const NodePtr folder = find(path.parent_path().native());
  return folder && folder->is_folder ? folder : nullptr;
}

bool SimulatedPlatform::take_space(std::size_t bytes) {
  if (faults_.space < 0) return true;
  if (faults_.space < static_cast<long>(bytes)) {
    all_hit_ = true;
    return false;
  }
  faults_.space -= static_cast<long>(bytes);
  return true;
}

// Null, and errno.
SimulatedPlatform::NodePtr SimulatedPlatform::make_node(const Path& path, bool is_folder) {
  std::string name;
  const NodePtr folder = folder_of(path, name);
  if (!folder) return errno = ENOENT, nullptr;
  if (!take_space(1)) return errno = ENOSPC, nullptr;
  auto node = std::make_shared<FileNode>();
  node->is_folder = is_folder, node->inode = ++last_inode_;
  folder->names[name] = node;
  return node;
}

void SimulatedPlatform::look_after_watched() {
  if (watched_folder_.empty()) return;
  const bool is_there = find(watched_folder_) != nullptr;
  if (had_folder_ && !is_there && faults_.can_exchange) lost_folder_ = true;
  had_folder_ = is_there;
}

SimulatedPlatform::Opened* SimulatedPlatform::opened(int descriptor) const {
  const auto found = opened_.find(descriptor);
  return found == opened_.end() ? nullptr : found->second.get();
}

int SimulatedPlatform::add_opened(std::unique_ptr<Opened> file) {
  opened_[++last_descriptor_] = std::move(file);
  return last_descriptor_;
}

void SimulatedPlatform::drop(Opened& file, int process) {
  if (std::erase(file.owners, process) == 0 || !file.owners.empty() || !file.pipe) return;
  --(file.is_reader ? file.pipe->readers : file.pipe->writers);
}

int SimulatedPlatform::open(const Path& path, int flags) {
  ask();
  note("opens", path);
  if (io_fails()) return errno = EIO, -1;
  NodePtr node = find(path.native());
  if (!node && !(flags & O_CREAT)) return errno = ENOENT, -1;
  if (!node && !(node = make_node(path, false))) return -1;
  if (node->is_folder) return errno = EISDIR, -1;
  if (flags & O_TRUNC) node->bytes.clear();
  auto file = std::make_unique<Opened>();
  file->file = node, file->owners = {current_->number};
  return add_opened(std::move(file));
}

ssize_t SimulatedPlatform::read(int descriptor, char* bytes, std::size_t count) {
  ask();
  Opened* file = opened(descriptor);
  if (!file) return errno = EBADF, -1;
  if (dice_.chance(faults_.interrupted_call)) return errno = EINTR, -1;
  if (file->pipe) {
    std::string& there = file->pipe->bytes;
    if (there.empty() && file->pipe->writers > 0) return errno = EAGAIN, -1;
    const std::size_t taken = std::min(count, there.size());
    std::memcpy(bytes, there.data(), taken);
    there.erase(0, taken);
    return static_cast<ssize_t>(taken);
  }
  if (io_fails()) return errno = EIO, -1;
  const std::string& there = file->file->bytes;
  const std::size_t taken = std::min(count, there.size() - std::min(file->at, there.size()));
  std::memcpy(bytes, there.data() + file->at, taken);
  file->at += taken;
  return static_cast<ssize_t>(taken);
}

ssize_t SimulatedPlatform::write(int descriptor, const char* bytes, std::size_t count) {
  ask();
  Opened* file = opened(descriptor);
  if (!file) return errno = EBADF, -1;
  if (dice_.chance(faults_.interrupted_call)) return errno = EINTR, -1;
  if (count > 1 && dice_.chance(faults_.short_write)) count = 1 + dice_.below(count - 1);
  if (file->pipe) {
    const std::shared_ptr<Pipe> pipe = file->pipe;
    if (pipe->bytes.size() >= faults_.pipe) {
      current_->full = pipe.get();
      block(kForever);
    }
    if (pipe->readers == 0) return errno = EPIPE, -1;
    count = std::min(count, faults_.pipe - pipe->bytes.size());
    pipe->bytes.append(bytes, count);
    note("sends", std::to_string(count));
    return static_cast<ssize_t>(count);
  }
  if (io_fails()) return errno = EIO, -1;
  if (faults_.space >= 0 && static_cast<long>(count) > faults_.space) {
    all_hit_ = true;
    if (faults_.space == 0) return errno = ENOSPC, -1;
    count = static_cast<std::size_t>(faults_.space);
  }
  take_space(count);
  note("writes", std::to_string(count));
  std::string& there = file->file->bytes;
  if (there.size() < file->at) there.resize(file->at);
  there.replace(file->at, std::min(count, there.size() - file->at), bytes, count);
  file->at += count;
  return static_cast<ssize_t>(count);
}

int SimulatedPlatform::truncate(int descriptor, std::size_t size) {
  ask();
  note("truncates");
  Opened* file = opened(descriptor);
  if (io_fails()) return errno = EIO, -1;
  file->file->bytes.resize(size), file->at = size;
  return 0;
}

void SimulatedPlatform::close(int descriptor) noexcept {
  if (!ask_quietly()) return;
  const auto found = opened_.find(descriptor);
  if (found == opened_.end()) return;
  drop(*found->second, current_->number);
  if (found->second->owners.empty()) opened_.erase(found);
}

int SimulatedPlatform::lock(int descriptor) {
  ask();
  Opened* file = opened(descriptor);
  for (const auto& [number, other] : opened_) {
    if (other->is_locked && other->file == file->file && other.get() != file) return errno = EWOULDBLOCK, -1;
  }
  file->is_locked = true;
  return 0;
}

ino_t SimulatedPlatform::inode(int descriptor) {
  ask();
  return opened(descriptor)->file->inode;
}

ino_t SimulatedPlatform::inode(const Path& path) {
  ask();
  const NodePtr node = find(path.native());
  return node ? node->inode : 0;
}

bool SimulatedPlatform::exchange(const Path& a, const Path& b) {
  ask();
  note("exchanges", b);
  if (!faults_.can_exchange) return false;
  std::string name_a, name_b;
  const NodePtr folder_a = folder_of(a, name_a), folder_b = folder_of(b, name_b);
  if (!folder_a || !folder_b || !folder_a->names.contains(name_a) || !folder_b->names.contains(name_b)) return false;
  std::swap(folder_a->names[name_a], folder_b->names[name_b]);
  return true;
}

bool SimulatedPlatform::link(const Path& file, const Path& name) {
  ask();
  note("links", name);
  if (!faults_.can_link || io_fails()) return false;
  const NodePtr node = find(file.native());
  std::string last;
  const NodePtr folder = folder_of(name, last);
  if (!node || !folder || folder->names.contains(last) || !take_space(1)) return false;
  folder->names[last] = node;
  return true;
}

bool SimulatedPlatform::exists(const Path& path) noexcept { return ask_quietly() && find(path.native()); }

bool SimulatedPlatform::is_file(const Path& path) {
  ask();
  const NodePtr node = find(path.native());
  return node && !node->is_folder;
}

bool SimulatedPlatform::is_folder(const Path& path) {
  ask();
  const NodePtr node = find(path.native());
  return node && node->is_folder;
}

void SimulatedPlatform::make_folders(const Path& path) {
  std::string so_far;
  each_name(path.native(), [&](std::string_view name) {
    so_far += so_far.empty() ? std::string(name) : "/" + std::string(name);
    if (find(so_far)) return;
    ask();
    if (io_fails()) fail_with(EIO, path);
    if (!find(so_far) && !make_node(so_far, true)) fail_with(errno, path);
  });
}

std::vector<Platform::Path> SimulatedPlatform::entries(const Path& folder) {
  ask();
  const NodePtr node = find(folder.native());
  if (!node || !node->is_folder) fail_with(ENOENT, folder);
  if (io_fails()) fail_with(EIO, folder);
  std::vector<Path> found;
  for (const auto& [name, below] : node->names) found.push_back(folder / name);
  for (std::size_t i = found.size(); i > 1; --i) std::swap(found[i - 1], found[dice_.below(i)]);
  return found;
}

void SimulatedPlatform::rename(const Path& from, const Path& to) {
  ask();
  note("renames", to);
  std::string old_name, new_name;
  const NodePtr old_folder = folder_of(from, old_name), new_folder = folder_of(to, new_name);
  if (!old_folder || !new_folder || !old_folder->names.contains(old_name)) fail_with(ENOENT, from);
  if (io_fails()) fail_with(EIO, from);
  const NodePtr node = old_folder->names.at(old_name);
  const auto there = new_folder->names.find(new_name);
  if (there != new_folder->names.end()) {
    if (there->second->is_folder != node->is_folder) fail_with(node->is_folder ? ENOTDIR : EISDIR, to);
    if (!there->second->names.empty()) fail_with(ENOTEMPTY, to);
  }
  old_folder->names.erase(old_name);
  new_folder->names[new_name] = node;
  look_after_watched();
}

void SimulatedPlatform::copy_node(const NodePtr& from, const Path& to) {
  ask();
  note("copies to", to);
  if (io_fails()) fail_with(EIO, to);
  if (find(to.native()) && !from->is_folder) fail_with(EEXIST, to);
  const NodePtr made = make_node(to, from->is_folder);
  if (!made) fail_with(errno, to);
  const auto below = from->names;
  for (const auto& [name, node] : below) copy_node(node, to / name);
  ask();
  if (!take_space(from->bytes.size())) fail_with(ENOSPC, to);
  made->bytes = from->bytes;
}

void SimulatedPlatform::copy(const Path& from, const Path& to) {
  const NodePtr node = find(from.native());
  if (!node) fail_with(ENOENT, from);
  copy_node(node, to);
}

// False if the process has died or the disk failed.
bool SimulatedPlatform::remove_below(FileNode& folder, const std::string& name, bool is_quiet) {
  const auto found = folder.names.find(name);
  if (found == folder.names.end()) return true;
  const NodePtr node = found->second;
  while (!node->names.empty()) {
    auto any = node->names.begin();
    std::advance(any, static_cast<long>(dice_.below(node->names.size())));
    if (!remove_below(*node, std::string(any->first), is_quiet)) return false;
  }
  if (is_quiet ? !ask_quietly() : (ask(), false)) return false;
  note("removes", name);
  if (io_fails()) return false;
  folder.names.erase(name);
  look_after_watched();
  return true;
}

bool SimulatedPlatform::remove_whole(const Path& path, bool is_quiet) {
  std::string name;
  const NodePtr folder = folder_of(path, name);
  return !folder || remove_below(*folder, name, is_quiet);
}

bool SimulatedPlatform::remove_one(const Path& path, bool is_quiet) {
  const NodePtr node = find(path.native());
  return node && !node->names.empty() ? false : remove_whole(path, is_quiet);
}

void SimulatedPlatform::remove(const Path& path) {
  ask();
  if (!remove_one(path, false)) fail_with(EIO, path);
}

void SimulatedPlatform::remove_all(const Path& path) {
  ask();
  if (!remove_whole(path, false)) fail_with(EIO, path);
}

void SimulatedPlatform::try_to_remove(const Path& path) noexcept {
  if (ask_quietly()) remove_one(path, true);
}

void SimulatedPlatform::try_to_remove_all(const Path& path) noexcept {
  if (ask_quietly()) remove_whole(path, true);
}

}  // namespace rigor::test
