#include "cases/report/csv/reaction_csv.h"

#include "cases/report/csv/trajectory_csv.h"

namespace rigor::inline report {

void append_reaction_row(std::string& out, const Scene& scene, const Joint& joint, double time, const Vec3& point,
                         const JointReaction& reaction) {
  append_number(out, time);
  const std::string ends = scene.body_name(joint.a) + " and " + scene.body_name(joint.b);
  out += ',' + csv_field(joint.name.empty() ? ends : joint.name);
  for (const Vec3& vector : {point, reaction.force, reaction.couple}) {
    for (int k = 0; k < 3; ++k) {
      out += ',';
      append_number(out, vector[k]);
    }
  }
  out += '\n';
}

}  // namespace rigor::inline report
