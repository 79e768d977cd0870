// Faults of the first joint: its place and its type.
#include "adapters/faults/changes.h"
#include "adapters/faults/faults.h"

namespace rigor::inline adapters {
namespace {

using namespace faulty;

template <typename F>
std::function<void(Scene&)> first_hinge(F change) {
  return [change](Scene& scene) {
    if (scene.joints.empty()) return;
    if (auto* hinge = std::get_if<HingeJoint>(&scene.joints[0].type)) change(*hinge, scene.joints[0]);
  };
}

}  // namespace

std::vector<Fault> joint_faults() {
  return {
      by_amount("a hinge's anchor off by {} mm", 1,
                [](double millimetres) {
                  return on_loading("", first_hinge([=](HingeJoint& hinge, Joint&) {
                                      hinge.anchor += Vec3(1e-3 * millimetres, 0, 0);
                                    }));
                }),
      by_amount("a hinge's axis off by {} mrad", 1,
                [](double milliradians) {
                  return on_loading("", first_hinge([=](HingeJoint& hinge, Joint&) {
                                      hinge.axis = (hinge.axis + Vec3(1e-3 * milliradians, 0, 0)).normalized();
                                    }));
                }),
      on_loading("a hinge taken for a ball", first_hinge([](HingeJoint& hinge, Joint& joint) {
                   const Vec3 anchor = hinge.anchor;
                   joint.type = BallJoint{anchor};
                 })),
      on_loading("an armature left out",
                 [](Scene& s) {
                   for (Joint& joint : s.joints) joint.armature = 0;
                 }),
      on_loading("a coupling's ratio inverted",
                 [](Scene& s) {
                   for (Coupling& coupling : s.couplings)
                     for (JointTerm& term : coupling.to) term.ratio = 1 / term.ratio;
                 }),
      on_loading("a joint left out", [](Scene& s) { s.joints.clear(), s.couplings.clear(), s.motors.clear(); }),
  };
}

}  // namespace rigor::inline adapters
