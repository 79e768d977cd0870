// rigor-mpi: rigor with its grids and sweeps shared among the ranks of an MPI run. MPI starts a guard, which reports
// the end of a rank that cannot report it itself.
#include <fmt/format.h>
#include <mpi.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "cases/cli/commands.h"
#include "cases/cli/mpi/mpi_executor.h"
#include "cases/cli/output.h"
#include "cases/cli/program.h"

namespace {

volatile std::sig_atomic_t guarded = 0, was_told_to_end = 0;

int be_a_rank(int argc, char** argv) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  MPI_Init(&argc, &argv);
  int code = rigor::kBroken;
  try {
    const rigor::MpiExecutor executor;
    code = rigor::run_program(argc, argv, &executor);
    if (!executor.leads()) code = rigor::kGood;  // the leader answers for all
  } catch (const rigor::Interrupted&) {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (rank != 0) _exit(rigor::kBroken);  // whoever interrupts ends all
    rigor::say(rigor::interruption_text(argc, argv));
    MPI_Abort(MPI_COMM_WORLD, rigor::kBroken);
  }
  MPI_Finalize();
  return code;
}

// Passes signals on to the rank, and exits as the rank does.
int guard(pid_t rank) {
  guarded = rank;
  for (const int number : {SIGINT, SIGTERM, SIGHUP})
    std::signal(number, [](int signal) { was_told_to_end = 1, kill(static_cast<pid_t>(guarded), signal); });
  int status = 0;
  while (waitpid(rank, &status, 0) < 0) {
    if (errno != EINTR) return rigor::kBroken;
  }
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  if (was_told_to_end || WTERMSIG(status) == SIGTERM)
    return rigor::kBroken;  // by an MPI that ends all ranks, for what another one has said
  const char* name = sigabbrev_np(WTERMSIG(status));
  rigor::say(
      fmt::format("a rank was killed by SIG{}; no output was changed. "
                  "The same command with --resume continues the run, on any number of ranks",
                  name ? name : "?"));
  return rigor::kBroken;
}

}  // namespace

int main(int argc, char** argv) {
  const pid_t rank = fork();
  if (rank < 0) return rigor::say("a rank could not be started"), rigor::kBroken;
  return rank == 0 ? be_a_rank(argc, argv) : guard(rank);
}
