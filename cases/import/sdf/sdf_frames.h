// The frames of an SDF file. Each has a name in its model and a pose relative to another frame. A frame of an inner
// model is called "inner::frame", and the model's own frame `__model__`.
#pragma once

#include <map>
#include <string>

#include "cases/import/xml.h"

namespace rigor::inline imports {

class SdfFrames {
 public:
  // `scope`: "" of the world, else "outer::inner::". An empty `relative_to` is W. A name given twice is refused.
  void add(const std::string& scope, const std::string& name, const BodyPose& pose, const std::string& scope_of_base,
           const std::string& relative_to, const XmlElement& element);
  void attach(const std::string& scope, const std::string& name, const std::string& to);  // a frame to what carries it
  bool has(const std::string& scope, const std::string& name) const { return frames_.contains(scope + name); }

  // Returns the pose in W. Throws InputError for an unknown frame and for frames placed in a circle.
  BodyPose pose(const std::string& scope, const std::string& name, const XmlElement& asked_by);
  // Follows attachments to the last frame. Returns the frame itself if it is attached to nothing.
  std::string carrier(const std::string& scope, const std::string& name, const XmlElement& asked_by) const;

 private:
  struct Frame {
    BodyPose pose;
    std::string base;  // whole name; "" is W
    std::string where;
    bool is_known = false;
  };
  Frame& find(const std::string& whole, const XmlElement& asked_by);

  std::map<std::string, Frame> frames_;
  std::map<std::string, std::string> attached_;
};

}  // namespace rigor::inline imports
