#include "cases/import/sdf/sdf_frames.h"

#include <fmt/format.h>

#include "core/base/near_match.h"

namespace rigor::inline imports {
namespace {

constexpr const char* kWorldFrame = "world";

}  // namespace

void SdfFrames::add(const std::string& scope, const std::string& name, const BodyPose& pose,
                    const std::string& scope_of_base, const std::string& relative_to, const XmlElement& element) {
  const std::string base = relative_to.empty() || relative_to == kWorldFrame ? "" : scope_of_base + relative_to;
  const auto [found, is_new] = frames_.try_emplace(scope + name, Frame{pose, base, element.where()});
  if (!is_new) element.refuse(fmt::format("another one has the name '{}', at {}", name, found->second.where));
}

void SdfFrames::attach(const std::string& scope, const std::string& name, const std::string& to) {
  attached_[scope + name] = scope + to;
}

SdfFrames::Frame& SdfFrames::find(const std::string& whole, const XmlElement& asked_by) {
  const auto found = frames_.find(whole);
  if (found != frames_.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [name, frame] : frames_) names.push_back(name);
  asked_by.refuse(fmt::format("there is no frame '{}'{}", whole, did_you_mean(whole, names)));
}

BodyPose SdfFrames::pose(const std::string& scope, const std::string& name, const XmlElement& asked_by) {
  if (name.empty() || name == kWorldFrame) return {};
  std::vector<Frame*> chain;
  for (std::string whole = scope + name; !whole.empty();) {
    Frame& frame = find(whole, asked_by);
    if (frame.is_known) break;
    if (chain.size() > frames_.size())
      asked_by.refuse(fmt::format("frame '{}' is placed relative to itself, in a circle", whole));
    chain.push_back(&frame);
    whole = frame.base;
  }
  for (auto frame = chain.rbegin(); frame != chain.rend(); ++frame) {
    if (!(*frame)->base.empty()) (*frame)->pose = find((*frame)->base, asked_by).pose * (*frame)->pose;
    (*frame)->is_known = true;
  }
  return find(scope + name, asked_by).pose;
}

std::string SdfFrames::carrier(const std::string& scope, const std::string& name, const XmlElement& asked_by) const {
  std::string whole = scope + name;
  for (std::size_t n = 0;; ++n) {
    const auto found = attached_.find(whole);
    if (found == attached_.end()) return whole;
    if (n > attached_.size()) asked_by.refuse(fmt::format("frame '{}' is attached to itself, in a circle", whole));
    whole = found->second;
  }
}

}  // namespace rigor::inline imports
