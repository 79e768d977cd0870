// rigor-mpi by mpirun: the same results as one process, whatever happens to a rank.
#include <boost/test/unit_test.hpp>

#include "tests/cases/cli/program.h"
#include "tests/cases/cli/without_timings.h"

using namespace rigor;

namespace cases_cli_mpi {

using Json = nlohmann::json;

constexpr const char* kGate = R"([[gate]]
metric = "position_error"
max = 1e-30
engines = ["core:rk4"]
because = "no method is exact here, so that it fails"
)";

struct Ranks : Program {
  Ranks() {
    for (const std::string name : {"a", "b", "c", "d"})
      folder.write("suite/springs/" + name + ".toml", std::string(kSprungCube) + kGate);
  }
  // Of a shell, with the folder as the current one.
  Answer shell(const std::string& command) const {
    const std::string environment =
        "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1"
        " OMPI_MCA_btl_vader_single_copy_mechanism=none; ";
    const int status = std::system(
        ("cd '" + folder.path.string() + "' && { " + environment + command + "; } >stdout 2>stderr").c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content("stdout"), content("stderr")};
  }
  Answer ranks(int count, const std::string& words) const {
    return shell("mpirun -n " + std::to_string(count) + " " RIGOR_MPI_PROGRAM " " + words);
  }
  void check_same_tables(const std::string& folder_of_it) const {
    for (const std::string file : {"/sweep.csv", "/sweep.jsonl", "/sweep.html"}) {
      BOOST_TEST(!content("whole" + file).empty());
      BOOST_TEST(content("whole" + file) == content(folder_of_it + file), folder_of_it + file);
    }
  }
};

const std::string kSweep =
    "sweep a b --vary scene.spring[0].stiffness=1e3..1e5:log:40 --vary scene.body.cube.mass=50,200 --engine ode"
    " --engine core:rk4 --suite suite --dt 1/1000 --out ";

// The journal has got somewhere.
std::string wait_for_progress(const std::string& out) {
  return "for i in $(seq 1200); do [ \"$(stat -c %s " + out +
         "/.rigor-partial/journals/sweep.journal 2>/dev/null || echo 0)\" -gt 2000 ] && break; sleep 0.05; done; ";
}

}  // namespace cases_cli_mpi

BOOST_FIXTURE_TEST_SUITE(cases_cli_mpi, Ranks)

// One process; three shards merged; three ranks; ranks that are killed, and another number of them that goes on.
BOOST_AUTO_TEST_CASE(four_ways_lead_to_the_same_tables) {
  BOOST_TEST(shell("'" RIGOR_PROGRAM "' " + kSweep + "whole --jobs 2").code == 0);
  for (const std::string k : {"1", "2", "3"})
    BOOST_TEST(shell("'" RIGOR_PROGRAM "' " + kSweep + "part" + k + " --shard " + k + "/3").code == 0);
  BOOST_TEST(shell("'" RIGOR_PROGRAM "' merge part1 part2 part3 --out merged").code == 0);
  check_same_tables("merged");
  const Answer three = ranks(3, kSweep + "three");
  BOOST_TEST(three.code == 0, three.err);
  check_same_tables("three");
  // A rank, and not its guard: the process that a guard has begun.
  const Answer killed =
      shell("mpirun -n 3 " RIGOR_MPI_PROGRAM " " + kSweep + "killed & m=$!; " + wait_for_progress("killed") +
            "for g in $(pgrep -P $m); do victim=$(pgrep -P $g | head -n 1); done; "
            "kill -KILL $victim; wait $m");
  BOOST_TEST(killed.code == 3, killed.err);
  BOOST_TEST(killed.err.find("--resume") != std::string::npos, killed.err);
  BOOST_TEST(content("killed/sweep.csv").empty());
  const Answer resumed = ranks(2, kSweep + "killed --resume");
  BOOST_TEST(resumed.code == 0, resumed.err);
  check_same_tables("killed");
}

BOOST_AUTO_TEST_CASE(a_gate_answers_the_same_over_ranks) {
  const std::string words = "gate --engine core:rk4 --engine ode --suite suite --out ";
  const Answer whole = shell("'" RIGOR_PROGRAM "' " + words + "whole"), shared = ranks(3, words + "shared");
  BOOST_TEST(whole.code == 1);
  BOOST_TEST(shared.code == 1, shared.err);
  // The table also has costs, which differ between measurements.
  const auto bounds = [](const std::string& out) { return out.substr(out.find("bounds:")); };
  BOOST_TEST(bounds(shared.out) == bounds(whole.out));
  BOOST_TEST(without_timings(Json::parse(content("whole/results.json"))) ==
             without_timings(Json::parse(content("shared/results.json"))));
}

BOOST_AUTO_TEST_CASE(only_one_rank_speaks) {
  const Answer list = ranks(3, "list truths"), bad = ranks(3, "gate springs/e --suite suite --out out");
  BOOST_TEST(list.code == 0);
  BOOST_TEST(list.out.find("oscillator") == list.out.rfind("oscillator"));
  BOOST_TEST(bad.code == 2, bad.err);
  BOOST_TEST(bad.err.find("rigor: ") == bad.err.rfind("rigor: "), bad.err);
  BOOST_TEST(!std::filesystem::exists(path("out/results.json")));
}

// Each rank in a folder of its own, as machines that share nothing would be.
BOOST_AUTO_TEST_CASE(a_folder_that_a_rank_does_not_see_is_refused) {
  const std::string here = "mkdir -p own$OMPI_COMM_WORLD_RANK && cd own$OMPI_COMM_WORLD_RANK && exec " RIGOR_MPI_PROGRAM
                           " gate --engine ode --suite ../suite --out out";
  const Answer answer = shell("mpirun -n 2 sh -c '" + here + "'");
  BOOST_TEST(answer.code == 2, answer.err);
  BOOST_TEST(answer.err.find("does not see the folder") != std::string::npos, answer.err);
  const std::string other =
      "exec " RIGOR_MPI_PROGRAM " gate --engine ode --suite suite --dt 1/100$OMPI_COMM_WORLD_RANK --out out";
  const Answer differs = shell("mpirun -n 2 sh -c '" + other + "'");
  BOOST_TEST(differs.code == 2, differs.err);
  BOOST_TEST(differs.err.find("another grid") != std::string::npos, differs.err);
}

BOOST_AUTO_TEST_SUITE_END()
