#include "adapters/mjcf/mujoco3_reader.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "adapters/mjcf/mujoco3_script.h"
#include "adapters/plugin/child_process.h"
#include "core/base/error.h"
#include "core/base/json.h"

namespace rigor::inline adapters {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolderVariable = "RIGOR_MUJOCO3";
constexpr double kTimeLimit = 60;                              // s
constexpr std::size_t kLongestModel = std::size_t{256} << 20;  // bytes

// It reads one request and writes one answer.
constexpr const char* kProcess = R"js(
import { createRequire } from "node:module";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { createInterface } from "node:readline";
const lines = createInterface({ input: process.stdin })[Symbol.asyncIterator]();
const request = JSON.parse((await lines.next()).value);
const answer = (value) => process.stdout.write(JSON.stringify(value) + "\n");
const found = createRequire(join(request.package, "x")).resolve("@mujoco/mujoco");
const warnings = [];
const mj = await (await import(pathToFileURL(found).href)).default({ print: (t) => warnings.push(t), printErr: (t) => warnings.push(t) });
const read = (name, encoding) => readFileSync(join(request.folder, name), encoding);
answer(answerTo(mj, request, read, warnings));
)js";

const std::vector<std::string> kArrays = {"body_parentid",
                                          "body_weldid",
                                          "body_jntnum",
                                          "body_jntadr",
                                          "body_mocapid",
                                          "body_mass",
                                          "body_inertia",
                                          "body_ipos",
                                          "body_iquat",
                                          "body_gravcomp",
                                          "jnt_type",
                                          "jnt_qposadr",
                                          "jnt_dofadr",
                                          "jnt_bodyid",
                                          "jnt_stiffness",
                                          "jnt_stiffnesspoly",
                                          "jnt_range",
                                          "dof_armature",
                                          "dof_damping",
                                          "dof_dampingpoly",
                                          "dof_frictionloss",
                                          "geom_type",
                                          "geom_contype",
                                          "geom_conaffinity",
                                          "geom_condim",
                                          "geom_bodyid",
                                          "geom_dataid",
                                          "geom_size",
                                          "geom_pos",
                                          "geom_quat",
                                          "geom_friction",
                                          "geom_priority",
                                          "geom_margin",
                                          "geom_gap",
                                          "mesh_vertadr",
                                          "mesh_vertnum",
                                          "mesh_vert",
                                          "hfield_adr",
                                          "hfield_nrow",
                                          "hfield_ncol",
                                          "hfield_size",
                                          "hfield_data",
                                          "exclude_signature",
                                          "eq_type",
                                          "eq_obj1id",
                                          "eq_obj2id",
                                          "eq_objtype",
                                          "eq_data",
                                          "tendon_adr",
                                          "tendon_num",
                                          "tendon_range",
                                          "tendon_stiffness",
                                          "tendon_stiffnesspoly",
                                          "tendon_damping",
                                          "tendon_dampingpoly",
                                          "tendon_frictionloss",
                                          "tendon_armature",
                                          "tendon_lengthspring",
                                          "wrap_type",
                                          "wrap_objid",
                                          "wrap_prm",
                                          "site_bodyid",
                                          "site_pos",
                                          "actuator_trntype",
                                          "actuator_dyntype",
                                          "actuator_gaintype",
                                          "actuator_biastype",
                                          "actuator_trnid",
                                          "actuator_gainprm",
                                          "actuator_biasprm",
                                          "actuator_gear",
                                          "actuator_ctrlrange",
                                          "actuator_forcerange",
                                          "actuator_damping",
                                          "actuator_armature",
                                          "actuator_delay",
                                          "qpos0",
                                          "qpos_spring",
                                          "nsensor",
                                          "nskin",
                                          "nflex",
                                          "nplugin",
                                          "npair"};

// "XML Error: … Element 'geom', line 5": the line goes where lines go.
[[noreturn]] void refuse_for(const MjcfSource& source, const std::string& parser, std::string why) {
  const std::size_t at = why.find("line ");
  const int line = at == std::string::npos ? 1 : std::max(1, std::atoi(why.c_str() + at + 5));
  for (char& c : why) c = static_cast<unsigned char>(c) < 32 ? ' ' : c;
  throw InputError(fmt::format("{}:{}: {} refuses the model: {}", source.path, line, parser, why.substr(0, 400)));
}

}  // namespace

std::string mujoco3_folder() {
  const char* folder = std::getenv(kFolderVariable);
  std::error_code error;
  const bool is_there = folder && fs::is_directory(fs::path(folder) / "node_modules/@mujoco/mujoco", error);
  return is_there ? fs::absolute(folder, error).string() : "";
}

CompiledMjcf read_with_mujoco3(const MjcfSource& source) {
  const fs::path path = source.path;
  std::error_code error;
  const Json request = {
      {"package", mujoco3_folder()},      {"folder", fs::absolute(path, error).parent_path().string()},
      {"file", path.filename().string()}, {"files", source.files},
      {"keyframe", source.keyframe},      {"arrays", kArrays}};
  // The limit of an import's memory is on this process. WebAssembly reserves addresses beyond it, and has limits
  // itself.
  ChildProcess node(fmt::format("sh -c \"ulimit -S -v unlimited 2>/dev/null; exec node --max-old-space-size=1000 "
                                "--input-type=module --eval \\\"\\$0\\\"\" '{}{}'",
                                kMujoco3Script, kProcess),
                    kTimeLimit, -1, "MuJoCo 3");
  const Json answer = Json::parse(node.ask(request.dump(), "read", kLongestModel));
  CompiledMjcf model;
  model.parser = "MuJoCo " + answer.at("version").get<std::string>();
  if (!answer.at("ok").get<bool>()) refuse_for(source, model.parser, answer.at("why").get<std::string>());
  model.adds_margins = answer.at("addsMargins").get<bool>();
  for (const auto& [name, values] : answer.at("numbers").items()) {
    std::vector<double>& row = model.numbers[name];
    for (const Json& value : values)  // JSON has no infinity
      row.push_back(value.is_boolean() ? double(value.get<bool>()) : value.is_number() ? value.get<double>() : 0);
  }
  for (const auto& [kind, values] : answer.at("names").items())
    model.names[kind] = values.get<std::vector<std::string>>();
  for (const Json& word : answer.at("off")) model.off.insert(word.get<std::string>());
  for (const Json& line : answer.at("warnings")) model.warnings.push_back(line.get<std::string>());
  return model;
}

}  // namespace rigor::inline adapters
