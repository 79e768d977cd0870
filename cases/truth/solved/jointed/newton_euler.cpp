#include "cases/truth/solved/jointed/jointed_motion.h"
#include "cases/truth/solved/jointed/jointed_ways.h"

namespace rigor::inline truth {
namespace {

using InPhases = solving::PhasedMotion<JointedMotion<double>>;

}  // namespace

std::unique_ptr<solving::DoubleMotion> jointed_motion_in_double(const Scene& scene, const ReferenceSolution& solution) {
  return std::make_unique<solving::InDouble<InPhases>>(InPhases(scene, solution));
}

namespace solving {

std::unique_ptr<DoubleMotion> newton_euler_in_double(const Scene& scene, const Nodes& nodes) {
  return std::make_unique<InDouble<InPhases>>(InPhases(scene, nodes));
}

Nodes newton_euler_nodes(const Scene& scene, const Way& way, const std::vector<double>& switches) {
  return nodes_of<JointedMotion<Extended>>(scene, way, switches);
}

}  // namespace solving
}  // namespace rigor::inline truth
