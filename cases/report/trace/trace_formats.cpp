#include "cases/report/trace/trace_formats.h"

#include <fmt/format.h>

#include <cmath>

#include "cases/report/csv/trajectory_csv.h"
#include "core/base/error.h"
#include "core/base/near_match.h"
#include "core/base/rotation_between.h"

namespace rigor::inline report {
namespace {

class CsvTrace : public TraceWriter {
 public:
  explicit CsvTrace(const Scene& scene) : scene_(scene) {}
  std::string begin(std::size_t) override { return csv_header() + "\n"; }
  std::string add(const Sample& sample) override {
    std::string rows;
    append_csv_rows(rows, scene_, sample.time, sample.bodies.columns());
    return rows;
  }

 private:
  const Scene& scene_;
};

}  // namespace

const std::vector<TraceFormat>& trace_formats() {
  static const std::vector<TraceFormat> formats = {
      {"csv", "time,body and the thirteen columns of a body's state", csv_trace},
      {"gltf", "glTF 2.0: shapes and their motion, for whatever shows three dimensions", gltf_trace},
      {"jsonl", "a line of JSON an instant", jsonl_trace},
      {"mcap", "MCAP with Foxglove's SceneUpdate and FrameTransforms", mcap_trace},
      {"npy", "a structured array of NumPy with the columns of csv", npy_trace}};
  return formats;
}

const TraceFormat& find_trace_format(const std::string& name) {
  std::vector<std::string> names;
  for (const TraceFormat& format : trace_formats()) {
    if (format.name == name) return format;
    names.push_back(format.name);
  }
  throw InputError(
      fmt::format("--format: there is no '{}'{}; there is: {}", name, did_you_mean(name, names), listed(names)));
}

std::unique_ptr<TraceWriter> csv_trace(const Scene& scene, bool has_contacts) {
  if (has_contacts) return contacts_trace(scene);  // a table has one kind of rows
  return std::make_unique<CsvTrace>(scene);
}

double drawn_metres_per_newton(const Scene& scene) {
  constexpr double kUsual = 9.81;  // m/s²
  double size = 0, mass = 0;
  for (const Body& body : scene.bodies) {
    if (body.fixed || !body.collides) continue;
    size += bounding_radius(*body.shape), mass += body.mass;
  }
  const double gravity = scene.gravity.isZero(0) ? kUsual : scene.gravity.norm();
  return mass > 0 ? size / (mass * gravity) : 0;
}

Shape drawn_shape(const Body& body) {
  if (body.shape) return *body.shape;
  // Of a solid ball the trace of the inertia is 6/5 m r².
  const double radius = body.fixed ? 0 : std::sqrt(body.inertia.trace() / body.mass * 5 / 6);
  return Sphere{radius > 0 && std::isfinite(radius) ? radius : 0.05};
}

BodyPose pose_of_plane(const Plane& plane) {
  return {plane.normal * plane.offset, rotation_between(Vec3::UnitZ(), plane.normal)};
}

}  // namespace rigor::inline report
