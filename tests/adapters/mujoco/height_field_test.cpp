// Height fields: written for MuJoCo, and read from its files.
#include <mujoco/mujoco.h>

#include <boost/test/unit_test.hpp>
#include <fstream>

#include "adapters/engines.h"
#include "adapters/mujoco/mujoco_library.h"
#include "adapters/mujoco/mujoco_mjcf.h"
#include "core/engine/run_name.h"
#include "tests/cases/import/imported.h"
#include "tests/folder.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(adapters_mujoco_height_field)

namespace {

constexpr double kStep = 1.0 / 1000;

// MuJoCo's own format of heights: two whole numbers, rows and columns, and then floats.
void write_heights(const std::string& path, int rows, int columns, const std::vector<float>& heights) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(&rows), sizeof rows);
  file.write(reinterpret_cast<const char*>(&columns), sizeof columns);
  file.write(reinterpret_cast<const char*>(heights.data()),
             static_cast<std::streamsize>(sizeof(float) * heights.size()));
}

// Five rows of four columns: no symmetry, and the largest and the smallest at places of their own.
const std::vector<float> kHills = {0.2f, 0.3f, 0.1f, 0.4f,  0.0f, 0.5f, 0.25f, 0.2f, 0.35f, 0.1f,
                                   0.6f, 0.1f, 0.2f, 0.15f, 0.3f, 1.0f, 0.4f,  0.3f, 0.2f,  0.1f};

std::string model(const std::string& field) {
  return R"(<mujoco><option timestep="0.001" integrator="Euler"/><asset>)" + field + R"(</asset><worldbody>
<geom type="hfield" hfield="hills" pos="0.1 -0.2 0.3"/>
<body name="ball" pos="0.35 0.1 1.3"><freejoint/><geom size="0.2" mass="2"/></body></worldbody></mujoco>)";
}

Vec3 ball_after(World& world, int steps) {
  for (int n = 0; n < steps; ++n) world.step(kStep);
  Snapshot now;
  world.read(now);
  return now.bodies().position(0);
}

}  // namespace

BOOST_AUTO_TEST_CASE(heights_of_a_file_are_at_their_places) {
  const Folder folder;
  write_heights((folder.path / "hills.bin").string(), 5, 4, kHills);
  const Scene scene =
      scene_of_file(folder.write("m.xml", model(R"(<hfield name="hills" file="hills.bin" size="2 3 0.5 0.6"/>)")));
  BOOST_TEST_REQUIRE(scene.bodies.size() == 2u);
  const Body& ground = scene.bodies[1];
  const Heightfield& field = std::get<Heightfield>(*ground.shape);
  BOOST_TEST((ground.fixed && ground.position == Vec3(0.1, -0.2, 0.3)));
  BOOST_TEST((field.size == std::array<double, 2>{4, 6}));
  BOOST_TEST_REQUIRE((field.heights.size() == 5u && field.heights[0].size() == 4u));
  for (std::size_t row = 0; row < 5; ++row) {
    for (std::size_t column = 0; column < 4; ++column)  // 0 and 1 are the extremes here, so shares stay as they are
      BOOST_TEST(std::abs(field.heights[row][column] - 0.5 * kHills[4 * row + column]) < 1e-7);
  }
}

// MuJoCo with the file, and MuJoCo with the scene that was read from it. A ball falls onto a slope and rolls down.
BOOST_AUTO_TEST_CASE(mujoco_moves_on_the_imported_field_as_on_its_own) {
  const Folder folder;
  write_heights((folder.path / "hills.bin").string(), 5, 4, kHills);
  const std::string path =
      folder.write("m.xml", model(R"(<hfield name="hills" file="hills.bin" size="2 3 0.5 0.6"/>)"));
  mujoco_library::start();
  char error[1000] = "";
  const mujoco_library::Model own(mj_loadXML(path.c_str(), nullptr, error, sizeof error));
  BOOST_TEST_REQUIRE((own != nullptr), error);
  const mujoco_library::Data data(mj_makeData(own.get()));
  const RunName run = parse_run_name("mujoco@stock", engines().infos());
  const auto world = find_engine(engines(), run.engine).load(scene_of_file(path), run.settings);
  bool has_touched = false;
  for (int n = 0; n < 500; ++n) mj_step(own.get(), data.get()), has_touched = has_touched || data->ncon > 0;
  BOOST_TEST(has_touched);
  const Vec3 there = Eigen::Map<const Vec3>(data->qpos), here = ball_after(*world, 500);
  BOOST_TEST((there - Vec3(0.35, 0.1, 1.3)).head<2>().norm() > 1e-3);  // it has left its place
  // Heights are rounded to floats once more: 6e-8 of 0.5 m, which the slope's direction feels.
  BOOST_TEST((here - there).norm() < 1e-6, here.transpose() << " and " << there.transpose());
}

// A platform is no endless plane: what walks over its edge falls.
BOOST_AUTO_TEST_CASE(level_heights_keep_their_border) {
  const std::string text = model(R"(<hfield name="hills" nrow="5" ncol="4" size="2 3 0.5 1"/>)");
  const Body ground = scene_of_text("m.xml", text).bodies[1];
  const Heightfield& field = std::get<Heightfield>(*ground.shape);
  BOOST_TEST((ground.position == Vec3(0.1, -0.2, 0.3)));
  BOOST_TEST((field.size == std::array<double, 2>{4, 6}));
  BOOST_TEST((field.heights == std::vector<std::vector<double>>{{0, 0}, {0, 0}}));
  BOOST_TEST(!some_has(left_out_of_model("m.xml", text), "height field"));
}

// One row of heights has no ground between them.
BOOST_AUTO_TEST_CASE(a_field_without_cells_is_lost) {
  for (const char* grid : {"nrow='1' ncol='1'", "nrow='1' ncol='4'", "nrow='5' ncol='1'"}) {
    const std::string field = "<hfield name='hills' " + std::string(grid) + " size='2 3 0.5 1'/>";
    BOOST_TEST(some_has(physics_lost("m.xml", model(field)), "a height field"), grid);
  }
}

// The track `matched` leaves the detector of MuJoCo 3, with which boxes do not rest on heights.
BOOST_AUTO_TEST_CASE(mujoco_3_is_told_which_detector_to_use_on_heights_alone) {
  Scene scene;
  Body box, ground;
  box.name = "box", box.shape = Box{{1, 1, 1}}, box.collides = true;
  Heightfield field;
  field.size = {4, 4}, field.heights.assign(3, std::vector<double>(3, 0.0));
  field.surface = height_surface(field.size, field.heights);
  ground.name = "ground", ground.fixed = true, ground.collides = true, ground.shape = field;
  scene.bodies = {box, ground};
  const auto says = [&](const MujocoVersion& version, Track track) {
    Settings settings;
    settings.method = "euler", settings.track = track;
    return mujoco_mjcf(scene, spanning_tree(scene), settings, version).find("nativeccd=\"disable\"") !=
           std::string::npos;
  };
  BOOST_TEST(says(kMujoco3, Track::matched));
  BOOST_TEST(!says(kMujoco3, Track::stock));
  BOOST_TEST(!says(kMujoco2, Track::matched));
  scene.bodies[1].shape = Plane{Vec3::UnitZ(), 0};
  BOOST_TEST(!says(kMujoco3, Track::matched));
}

BOOST_AUTO_TEST_SUITE_END()
