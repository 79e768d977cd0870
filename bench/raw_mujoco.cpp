#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "bench/raw_engines.h"

namespace rigor::bench {
namespace {

using ModelPointer = std::unique_ptr<mjModel, decltype(&mj_deleteModel)>;
using DataPointer = std::unique_ptr<mjData, decltype(&mj_deleteData)>;

std::string text_of(const Vec3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

std::string mjcf_of(const Scene& scene) {
  std::string text = fmt::format(
      R"(<mujoco><compiler angle="radian" balanceinertia="false" boundmass="0" boundinertia="0" autolimits="false"/>)"
      R"(<option gravity="{}" integrator="Euler" cone="elliptic" solver="Newton" tolerance="1e-10" iterations="200" )"
      R"(impratio="100"/><size nconmax="100" njmax="400"/><worldbody>)",
      text_of(scene.gravity));
  for (const Body& body : scene.bodies) {
    const Mat3& I = body.inertia;
    const Quat& q = body.orientation;
    text += fmt::format(R"(<body pos="{}" quat="{} {} {} {}"><inertial pos="0 0 0" mass="{}" )", text_of(body.position),
                        q.w(), q.x(), q.y(), q.z(), body.mass);
    text += fmt::format(R"(fullinertia="{} {} {} {} {} {}"/><freejoint/></body>)", I(0, 0), I(1, 1), I(2, 2), I(0, 1),
                        I(0, 2), I(1, 2));
  }
  return text + "</worldbody></mujoco>";
}

mjModel* model_of(const std::string& text) {
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "scene.xml", static_cast<int>(text.size()));
  std::memcpy(files->filedata[0], text.data(), text.size());
  char fault[1000] = "";
  mjModel* model = mj_loadXML("scene.xml", files.get(), fault, sizeof fault);
  mj_deleteVFS(files.get());
  if (!model) throw std::runtime_error(fault);
  return model;
}

class RawMujoco : public RawWorld {
 public:
  explicit RawMujoco(const Scene& scene)
      : model_(model_of(mjcf_of(scene)), mj_deleteModel), data_(mj_makeData(model_.get()), mj_deleteData) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const Body& body = scene.bodies[i];
      Eigen::Map<Vec3>(data_->qvel + 6 * i) = body.velocity;
      Eigen::Map<Vec3>(data_->qvel + 6 * i + 3) = body.orientation.conjugate() * body.angular_velocity;
    }
  }

  void run(int steps, double dt, std::vector<double>& out) override {
    out.resize(13 * static_cast<std::size_t>(model_->nv / 6));
    model_->opt.timestep = dt;
    for (int n = 0; n < steps; ++n) {
      mj_step(model_.get(), data_.get());
      read(out);
    }
  }

 private:
  void read(std::vector<double>& out) const {
    double* to = out.data();
    for (int i = 0; i < model_->nv / 6; ++i) {
      const mjtNum *q = data_->qpos + 7 * i, *v = data_->qvel + 6 * i;
      const Vec3 w = Quat(q[3], q[4], q[5], q[6]) * Vec3(v[3], v[4], v[5]);
      to = std::copy_n(q, 7, to);
      to = std::copy_n(v, 3, to);
      to = std::copy_n(w.data(), 3, to);
    }
  }

  ModelPointer model_;
  DataPointer data_;
};

}  // namespace

std::unique_ptr<RawWorld> raw_mujoco(const Scene& scene) { return std::make_unique<RawMujoco>(scene); }

}  // namespace rigor::bench
