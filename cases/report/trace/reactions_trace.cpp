// What an engine says that its joints carry: a mean over the step that ends at `time`. The columns are those of
// reaction_csv.h. The first step is left out, because an engine begins it with velocities of its own instant.
#include "cases/metrics/measures/joints/reported_at_joint.h"
#include "cases/report/csv/reaction_csv.h"
#include "cases/report/trace/trace_formats.h"

namespace rigor::inline report {
namespace {

class ReactionsTrace : public TraceWriter {
 public:
  explicit ReactionsTrace(const Scene& scene) : scene_(scene) {
    for (const Joint& joint : scene.joints) geometry_.emplace_back(scene, joint);
  }
  std::string begin(std::size_t) override { return kReactionHeader; }
  std::string add(const Sample& sample) override {
    std::string rows;
    for (std::size_t k = 0; k < sample.reactions.size(); ++k) {
      const BodyColumns start = before_.columns();
      append_reaction_row(rows, scene_, scene_.joints[k], sample.time, end_motion(geometry_[k].b(), start).point(),
                          reported_at_joint(scene_.joints[k], geometry_[k], sample.reactions[k], start));
    }
    before_ = sample.bodies;
    return rows;
  }

 private:
  const Scene& scene_;
  std::vector<JointGeometry> geometry_;
  KeptBodies before_;  // at the start of the step
};

}  // namespace

std::unique_ptr<TraceWriter> reactions_trace(const Scene& scene) { return std::make_unique<ReactionsTrace>(scene); }

}  // namespace rigor::inline report
