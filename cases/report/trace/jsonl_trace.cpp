// {"time": s, "bodies": [{"name", "position", "orientation_wxyz", "velocity", "angular_velocity"}, ...]}, units and
// frames as the case file's.

#include "cases/report/trace/trace_formats.h"
#include "core/base/json.h"

namespace rigor {
namespace {

Json numbers_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

class JsonLinesTrace : public TraceWriter {
 public:
  explicit JsonLinesTrace(const Scene& scene) : scene_(scene) {}
  std::string add(const Sample& sample) override {
    Json line = {{"time", sample.time}, {"bodies", Json::array()}};
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const BodyState state = sample.bodies.columns().body(i);
      const Quat& q = state.orientation;
      line["bodies"].push_back({{"name", scene_.bodies[i].name},
                                {"position", numbers_of(state.position)},
                                {"orientation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
                                {"velocity", numbers_of(state.velocity)},
                                {"angular_velocity", numbers_of(state.angular_velocity)}});
    }
    return line.dump() + "\n";
  }

 private:
  const Scene& scene_;
};

}  // namespace

std::unique_ptr<TraceWriter> jsonl_trace(const Scene& scene) { return std::make_unique<JsonLinesTrace>(scene); }

}  // namespace rigor
