// The frames of an SDF file: each is named in its model, and placed relative to another one by a pose. Names of inner
// models' frames are "inner::frame"; `__model__` is a model's own frame.
#pragma once

#include <map>
#include <string>

#include "cases/import/xml.h"

namespace rigor {

class SdfFrames {
 public:
  // `scope`: "" of the world, else "outer::inner::". An empty `relative_to` is W. A name given twice is refused.
  void add(const std::string& scope, const std::string& name, const BodyPose& pose, const std::string& scope_of_base,
           const std::string& relative_to, const XmlElement& element);
  void attach(const std::string& scope, const std::string& name, const std::string& to);  // a frame to what carries it
  bool has(const std::string& scope, const std::string& name) const { return frames_.contains(scope + name); }

  // In W. Throws InputError for a frame that is not there and for those that are placed relative to themselves.
  BodyPose pose(const std::string& scope, const std::string& name, const XmlElement& asked_by);
  // What a frame is attached to in the end; itself if it is attached to nothing.
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

}  // namespace rigor
