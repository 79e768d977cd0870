#include "cases/import/urdf_gazebo.h"

#include <utility>
#include <vector>

#include "cases/import/model_elements.h"

namespace rigor {

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
      {"laserRetro", kSaysNothing},
      {"provideFeedback", kSaysNothing},
      {"preserveFixedJoint", kSaysNothing},
      {"disableFixedJointLumping", kSaysNothing},
      {"selfCollide", assumed("links touch each other, but those of a joint")},
      {"static", lost("would bolt the robot to the world")}};
  element.check({{"reference"}, {"mu1", "mu2", "mu", "turnGravityOff", "gravity"}, kOthers}, model.left_out);
  if (found == links.end()) return;
  Link& link = model.links[found->second];
  const auto first = element.child("mu1"), second = element.child("mu2");
  if (first) {
    const double friction = not_negative(first->number_of_text(), "it", *first);
    for (LinkShape& shape : link.shapes) shape.surface.friction = friction;
    if (second && second->number_of_text() != friction)
      model.left_out.add(second->place(), "mu2", lost("differs from mu1: in a scene friction has no direction"));
  }
  const auto off = element.child("turnGravityOff"), gravity = element.child("gravity");
  if ((off && off->flag_of_text()) || (gravity && !gravity->flag_of_text())) link.lifted = 1;
}

}  // namespace rigor
