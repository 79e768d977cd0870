// {"time": s, "bodies": [{"name", "position", "orientation_wxyz", "velocity", "angular_velocity"}, ...]}, units and
// frames as the case file's. With contacts also "contacts": [{"a", "b", "point", "normal", "gap", "force"}, ...]; the
// force on b [N] is a mean over the step that ends at the time.

#include "cases/report/trace/trace_formats.h"
#include "core/base/json.h"

namespace rigor::inline report {
namespace {

Json numbers_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

class JsonLinesTrace : public TraceWriter {
 public:
  JsonLinesTrace(const Scene& scene, bool has_contacts) : scene_(scene), has_contacts_(has_contacts) {}
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
    if (has_contacts_) line["contacts"] = Json::array();
    for (const ReportedContact& contact : sample.contacts) {
      line["contacts"].push_back({{"a", scene_.body_name(contact.a)},
                                  {"b", scene_.body_name(contact.b)},
                                  {"point", numbers_of(contact.point)},
                                  {"normal", numbers_of(contact.normal)},
                                  {"gap", contact.gap},
                                  {"force", numbers_of(contact.force)}});
    }
    return line.dump() + "\n";
  }

 private:
  const Scene& scene_;
  bool has_contacts_;
};

}  // namespace

std::unique_ptr<TraceWriter> jsonl_trace(const Scene& scene, bool has_contacts) {
  return std::make_unique<JsonLinesTrace>(scene, has_contacts);
}

}  // namespace rigor::inline report
