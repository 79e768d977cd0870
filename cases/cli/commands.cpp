#include "cases/cli/commands.h"

namespace rigor {

const std::vector<std::string> kGridOptions = {"--deviations", "--dt",    "--duration", "--engine",
                                               "--jobs",       "--out",   "--plugin",   "--resume",
                                               "--shard",      "--suite", "--timeout",  "--verbose"};
const std::vector<std::string> kGateOptions = {"--deviations", "--dt",      "--duration", "--engine", "--jobs",
                                               "--out",        "--plugin",  "--quick",    "--resume", "--shard",
                                               "--suite",      "--timeout", "--verbose"};
constexpr const char* kCases = "case ids, families, files or folders";
constexpr const char* kCasesOrAll = "case ids, families, files or folders; default: the whole suite";

// Commands that simulate and judge.
std::vector<CommandRow> commands_that_run() {
  return {
      {"list",
       "list cases, engines, integrators, metrics and truths",
       "KIND",
       "cases, engines, integrators, metrics or truths; default: all",
       {"--plugin", "--suite"},
       {{"rigor list", "everything"},
        {"rigor list cases engines", "two of the lists"},
        {"rigor list engines --plugin 'python3 my_engine.py'", "with an engine of your own"}},
       list_command},
      {"run",
       "simulate cases, judge the results, print a table and write reports",
       "CASE",
       kCasesOrAll,
       kGridOptions,
       {{"rigor run springs/fixed-spring", "one case by every engine; the report is out/report.html"},
        {"rigor run springs --engine ode --engine core:rk4 --dt 1/60", "a family of cases, two engines, one step size"},
        {"rigor run robot.urdf my-case.toml --out robots", "files of your own"}},
       run_command},
      {"gate",
       "run, and exit 1 if a gate does not hold",
       "CASE",
       kCasesOrAll,
       kGateOptions,
       {{"rigor gate --quick", "for each change: the fast gates of the whole suite"},
        {"rigor gate --engine bullet", "all gates of one engine"},
        {"rigor gate springs --plugin ./my_engine.so", "an engine of your own against one family"}},
       gate_command},
      {"sweep",
       "run cases over steps, options and values of the scene; write a table and maps",
       "CASE",
       kCases,
       {"--dt", "--duration", "--engine", "--jobs", "--metric", "--out", "--plugin", "--resume", "--sample", "--seed",
        "--shard", "--suite", "--timeout", "--vary"},
       {{"rigor sweep springs/stiff-1 --vary dt=1/1000..1/10:log:20 --engine ode", "twenty step sizes"},
        {"rigor sweep springs/stiff-1 --vary dt=1/100,1/200 --vary duration=1,2 --engine core:rk4",
         "a grid of two axes"}},
       sweep_command},
      {"tune",
       "find the cheapest setting of an engine within bounds; exit 1 if there is none",
       "CASE",
       kCases,
       {"--duration", "--engine", "--jobs", "--plugin", "--seed", "--suite", "--timeout", "--within"},
       {{"rigor tune springs/fixed-spring --engine ode --within 1mm", "position within a millimetre"},
        {"rigor tune springs --engine bullet --within 1cm --within '2% energy'", "two bounds on a family"}},
       tune_command},
      {"merge",
       "merge the results of --shard runs into one result",
       "DIR",
       "the output folders of all parts",
       {"--deviations", "--out", "--plugin", "--suite"},
       {{"rigor merge part1 part2 part3 --out whole", "three parts, made by --shard 1/3, 2/3 and 3/3"},
        {"rigor merge parts/* --out whole", "all folders in parts"}},
       merge_command},
  };
}

// Commands that read results.
std::vector<CommandRow> commands_on_results() {
  return {
      {"compare",
       "list what improved or got worse between two results; exit 1 if anything got worse",
       "FILE",
       "OLD and NEW, each a results.json or a baseline",
       {"--factor"},
       {{"rigor compare old/results.json out/results.json", "two runs"},
        {"rigor compare baseline.txt out/results.json --factor 1.5", "ignore errors that grow by less than half"}},
       compare_command},
      {"baseline",
       "print the short form of a result, one line a cell, to keep and compare with",
       "FILE",
       "a results.json",
       {"--regression"},
       {{"rigor baseline out/results.json > baseline.txt", "keep a result"},
        {"rigor baseline out/results.json --regression ode", "the values for adapters/ode/regression.jsonl"}},
       baseline_command},
      {"history",
       "add a result to a history, or show errors and costs along it",
       "ACTION",
       "add and the folder of a run; or show and parts of case and engine names",
       {"--file", "--page"},
       {{"rigor history add out", "add the run in out/ to history.jsonl"},
        {"rigor history show springs ode --page history.html", "show some of it, as a page too"}},
       history_command},
      {"open",
       "show the report of a run in the browser",
       "",
       "",
       {"--out"},
       {{"rigor open", "the report in out/"}, {"rigor open --out nightly", "the report in nightly/"}},
       open_command},
  };
}

// Commands on one case, one file or one engine.
std::vector<CommandRow> commands_on_one() {
  return {
      {"trace",
       "print one trajectory as CSV, JSON lines, MCAP or glTF",
       "CASE",
       "a case or a file",
       {"--dt", "--duration", "--engine", "--every", "--format", "--plugin", "--suite", "--timeout"},
       {{"rigor trace springs/fixed-spring --engine ode --dt 1/240 > ode.csv", "a table of all samples"},
        {"rigor trace robot.urdf --engine core:rk4 --dt 1/240 --format gltf > robot.gltf", "an animation"},
        {"rigor trace ballistic/fast-spin --engine bullet --dt 1/60 --every 6", "each sixth sample"}},
       trace_command},
      {"truth",
       "print the states of the truth and its own error as CSV",
       "CASE",
       "a case or a file",
       {"--duration", "--suite", "--timeout", "--times"},
       {{"rigor truth springs/fixed-spring", "at every coarsest step of the run"},
        {"rigor truth springs/fixed-spring --times 1,2,5/2", "at three instants"}},
       truth_command},
      {"new",
       "write a case file that runs, with a comment on each line",
       "NAME",
       "name of the case, as my-case",
       {},
       {{"rigor new my-case", "write my-case.toml"}, {"rigor new cases/pendulum", "write cases/pendulum.toml"}},
       new_command},
      {"import",
       "print a robot's file (URDF, SDF or MJCF) as a case file; stderr lists what was left out",
       "FILE",
       "a file that ends in .urdf, .sdf, .mjcf or .xml",
       {"--keyframe"},
       {{"rigor import robot.urdf > robot.toml", "a case file to edit"},
        {"rigor import humanoid.xml --keyframe squat > squat.toml", "start from a keyframe of MJCF"}},
       import_command},
      {"export",
       "print a case's scene for other programs; stderr lists what was left out",
       "CASE",
       "a case or a file",
       {"--format", "--suite"},
       {{"rigor export joints/double-pendulum --format mjcf > pendulum.xml", "for MuJoCo"},
        {"rigor export joints/double-pendulum --format sdf > pendulum.sdf", "for Gazebo"}},
       export_command},
      {"settle",
       "print a case file with the nearest initial velocities that its joints allow",
       "FILE",
       "a case file",
       {},
       {{"rigor settle my-case.toml > settled.toml", "correct velocities that break a joint"}},
       settle_command},
      {"conform",
       "check an engine against the interface; exit 1 if a check fails",
       "",
       "",
       {"--engine", "--jobs", "--json", "--plugin", "--timeout"},
       {{"rigor conform --plugin 'python3 my_engine.py'", "an engine of your own"},
        {"rigor conform --engine ode --json", "a built-in engine, as JSON"}},
       conform_command},
      {"diagnose",
       "name the known mistake that explains an engine's error",
       "CASE",
       "case ids, families, files or folders; default: cases that tell mistakes apart",
       {"--engine", "--jobs", "--json", "--plugin", "--suite", "--timeout"},
       {{"rigor diagnose --plugin ./my_engine.so", "an engine of your own"},
        {"rigor diagnose springs/fixed-spring --engine ode", "on one case"}},
       diagnose_command},
      {"completion",
       "print completions for a shell, or the manual page",
       "KIND",
       "bash, zsh or man",
       {},
       {{"rigor completion bash > ~/.local/share/bash-completion/completions/rigor", "for bash"},
        {"rigor completion man | man -l -", "read the manual page"}},
       completion_command},
  };
}

std::vector<CommandRow> all_commands() {
  std::vector<CommandRow> all = commands_that_run();
  for (const auto& more : {commands_on_results(), commands_on_one()}) all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace

const std::vector<CommandRow>& commands() {
  static const std::vector<CommandRow> table = {
      list_row(),     run_row(),     gate_row(),    sweep_row(),    tune_row(),       merge_row(), compare_row(),
      baseline_row(), history_row(), open_row(),    trace_row(),    truth_row(),      new_row(),   import_row(),
      export_row(),   settle_row(),  conform_row(), diagnose_row(), completion_row(),
  };
  return table;
}

}  // namespace rigor
