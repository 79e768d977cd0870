#include "cases/import/urdf_gazebo.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "cases/import/model_elements.h"
#include "cases/import/sdf/sdf_link.h"

namespace rigor::inline imports {

namespace {

// <mu1>0.5</mu1>, or as older files have it <mu1 value="0.5"/>.
double friction_of(const XmlElement& element, LeftOut& left_out) {
  element.check({{"value"}, {}}, left_out);
  return not_negative(element.find("value") ? element.number("value") : element.number_of_text(), "it", element);
}

// Likewise.
bool flag_of(const XmlElement& element, LeftOut& left_out) {
  element.check({{"value"}, {}}, left_out);
  const auto value = element.find("value");
  if (!value) return element.flag_of_text();
  if (*value == "true" || *value == "1") return true;
  if (*value != "false" && *value != "0")
    element.refuse(fmt::format("attribute 'value': found '{}'; allowed: true, false", *value));
  return false;
}

}  // namespace

BodyPose pose_of_urdf_model(const XmlElement& robot, LeftOut& left_out) {
  for (const XmlElement& element : robot.children("gazebo")) {
    const auto pose = element.child("pose");
    if (element.find("reference") || !pose) continue;
    if (pose->find("relative_to") || pose->find("frame"))
      left_out.add(pose->place(), "a pose", lost("is relative to a frame; a model's pose is read in the world"));
    return sdf_pose(pose, left_out);
  }
  return {};
}

void read_urdf_gazebo(const XmlElement& element, const std::map<std::string, std::size_t>& links, LinkModel& model) {
  const auto name = element.find("reference");
  const auto found = name ? links.find(*name) : links.end();
  static const std::vector<std::pair<std::string, Reason>> kOthers = {
      {"material", kIsSeen},
      {"visual", kIsSeen},
      {"sensor", kSensor},
      {"plugin", kController},
      {"kp", kOfASolver},
      {"kd", kOfASolver},
      {"minDepth", kOfASolver},
      {"maxVel", kOfASolver},
      {"maxContacts", kOfASolver},
      {"fdir1", kOfASolver},
      {"stopCfm", kOfASolver},
      {"stopErp", kOfASolver},
      {"stopKp", kOfASolver},
      {"stopKd", kOfASolver},
      {"implicitSpringDamper", kOfASolver},
      {"fudgeFactor", kOfASolver},
      {"laserRetro", kSaysNothing},
      {"canonicalBody", kSaysNothing},
      {"provideFeedback", kSaysNothing},
      {"preserveFixedJoint", kSaysNothing},
      {"disableFixedJointLumping", kSaysNothing},
      {"selfCollide", assumed("links touch each other, but those of a joint")},
      {"static", lost("would bolt the robot to the world")}};
  std::vector<std::string> read = {"mu1", "mu2", "mu", "turnGravityOff", "gravity"};
  if (!name) read.push_back("pose");
  std::vector<std::pair<std::string, Reason>> others = kOthers;
  for (const XmlElement& child : element.children()) {  // of Gazebo before 1.0
    if (child.name().starts_with("controller:")) others.emplace_back(child.name(), kController);
    if (child.name().starts_with("sensor:")) others.emplace_back(child.name(), kSensor);
  }
  element.check({{"reference"}, read, others}, model.left_out);
  if (found == links.end()) return;
  Link& link = model.links[found->second];
  const auto first = element.child("mu1"), second = element.child("mu2");
  if (first) {
    const double friction = friction_of(*first, model.left_out);
    for (LinkShape& shape : link.shapes) shape.surface.friction = friction;
    if (second && friction_of(*second, model.left_out) != friction)
      model.left_out.add(second->place(), "mu2", lost("differs from mu1: in a scene friction has no direction"));
  }
  const auto off = element.child("turnGravityOff"), gravity = element.child("gravity");
  if ((off && flag_of(*off, model.left_out)) || (gravity && !flag_of(*gravity, model.left_out))) link.lifted = 1;
}

}  // namespace rigor::inline imports
