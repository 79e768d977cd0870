// One run's motion in formats of other programs. Each is a row of the table. A writer gets the samples one by one and
// returns the data to write next.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/engine/trajectory.h"
#include "core/scene/scene.h"

namespace rigor::inline report {

class TraceWriter {
 public:
  virtual ~TraceWriter() = default;
  // `samples`: how often add() will be called.
  virtual std::string begin(std::size_t samples) {
    static_cast<void>(samples);
    return "";
  }
  virtual std::string add(const Sample& sample) = 0;
  virtual std::string end() { return ""; }
};

struct TraceFormat {
  std::string name, summary;
  // The scene must live on. With contacts, a sample's contact forces are written, too.
  std::unique_ptr<TraceWriter> (*writer)(const Scene& scene, bool has_contacts);
};

const std::vector<TraceFormat>& trace_formats();                // "csv" first, which is the default
const TraceFormat& find_trace_format(const std::string& name);  // throws InputError

std::unique_ptr<TraceWriter> contacts_trace(const Scene& scene);   // CSV of contact forces in place of bodies
std::unique_ptr<TraceWriter> reactions_trace(const Scene& scene);  // CSV of reported joint loads, of every step
std::unique_ptr<TraceWriter> csv_trace(const Scene& scene, bool has_contacts);
std::unique_ptr<TraceWriter> gltf_trace(const Scene& scene, bool has_contacts);
std::unique_ptr<TraceWriter> jsonl_trace(const Scene& scene, bool has_contacts);
std::unique_ptr<TraceWriter> mcap_trace(const Scene& scene, bool has_contacts);
std::unique_ptr<TraceWriter> npy_trace(const Scene& scene, bool has_contacts);

// How long the arrow of a force of 1 N is drawn [m]: that of a body's weight is as long as the body's bounding radius,
// in the mean over the bodies that move and collide. Without gravity 9.81 m/s² stands for it.
double drawn_metres_per_newton(const Scene& scene);

// What a body is drawn as: its shape, or the ball of its mean inertia where it has none.
Shape drawn_shape(const Body& body);

// Half the edge of the square that a plane is drawn as [m], about the foot of the world's origin on it.
inline constexpr double kDrawnPlane = 10;
BodyPose pose_of_plane(const Plane& plane);  // its z is the normal

}  // namespace rigor::inline report
