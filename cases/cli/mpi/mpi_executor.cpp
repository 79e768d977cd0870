#include "cases/cli/mpi/mpi_executor.h"

#include <fmt/format.h>
#include <mpi.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <random>
#include <thread>

#include "core/base/content_hash.h"
#include "core/base/error.h"
#include "core/base/json.h"

namespace rigor::inline cli {
namespace {

// What ranks say. A helper: what it has planned, whether it sees the folder, that it can take a job, what a job says
// and how it ended, that it leaves. The leader: the folder's sign, a job, that all is over.
enum Tag { kPlan, kSeen, kWant, kMessage, kEnd, kBye, kFolder, kJob, kOver };

constexpr int kLeader = 0;
constexpr const char* kSign = "team";  // the file of the folder that tells it from one of another machine's
constexpr auto kNap = std::chrono::milliseconds(1);

struct Letter {
  int rank, tag;
  std::string text;
};

void send(int rank, Tag tag, const std::string& text = "") {
  MPI_Send(text.data(), static_cast<int>(text.size()), MPI_BYTE, rank, tag, MPI_COMM_WORLD);
}

std::optional<Letter> next_letter() {
  int is_there = 0, length = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &is_there, &status);
  if (!is_there) return {};
  MPI_Get_count(&status, MPI_BYTE, &length);
  Letter letter{status.MPI_SOURCE, status.MPI_TAG, std::string(static_cast<std::size_t>(length), '\0')};
  MPI_Recv(letter.text.data(), length, MPI_BYTE, letter.rank, letter.tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return letter;
}

Letter wait_for_letter() {
  for (;;) {
    if (auto letter = next_letter()) return std::move(*letter);
    std::this_thread::sleep_for(kNap);
  }
}

std::string text_of(std::size_t number, const JobSpec& job) {
  return Json{{"number", number},       {"kind", static_cast<int>(job.kind)},
              {"of_case", job.of_case}, {"limit", job.limit},
              {"part", job.part},       {"run", job.run},
              {"dt", job.dt.text}}
      .dump();
}

JobSpec job_from(const Json& json) {
  JobSpec job{static_cast<JobSpec::Kind>(json.at("kind").get<int>()), json.at("of_case").get<std::size_t>(),
              json.at("limit").get<double>(), json.at("part").get<std::size_t>(), json.at("run").get<std::string>()};
  const auto dt = json.at("dt").get<std::string>();
  if (!dt.empty()) job.dt = parse_step_size(dt, "dt");
  return job;
}

// Last words may be any bytes.
std::string text_of(std::size_t number, const JobEnd& end) {
  return Json{{"number", number}, {"how", static_cast<int>(end.how)}, {"code", end.code},
              {"text", end.text}, {"last_words", end.last_words},     {"seconds", end.seconds}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

JobEnd end_from(const Json& json) {
  return {static_cast<Ending>(json.at("how").get<int>()), json.at("code").get<int>(),
          json.at("text").get<std::string>(), json.at("last_words").get<std::string>(),
          json.at("seconds").get<double>()};
}

std::string hash_of(const std::string& plan) { return fmt::format("{:016x}", content_hash(plan)); }

std::string host() {
  char name[256] = "";
  gethostname(name, sizeof name - 1);
  return name;
}

std::string sign_in(const std::string& folder) {
  std::ifstream file(std::filesystem::path(folder) / kSign);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

// Hands the jobs of one call out, to helpers first, and hears of those. While plenty are left each may have one ahead,
// so that it need not wait for the next: on a busy machine an answer may take as long as a time slice of each other
// process.
class MpiExecutor::Leading : public FeedOfJobs {
 public:
  Leading(const MpiExecutor& team, JobSource& jobs, const Work& work, const OnMessage& on_message, const OnEnd& on_end)
      : FeedOfJobs(jobs, work), team_(team), on_message_(on_message), on_end_(on_end) {}

  bool is_over() override {
    while (const auto letter = next_letter()) take(*letter);
    for (std::size_t asked = team_.hungry_.size(); asked > 0 && left() > 0; --asked) {
      const int rank = team_.hungry_.front();
      team_.hungry_.pop_front();
      if (held_[rank] > 0 && !has_plenty()) {
        team_.hungry_.push_back(rank);
        continue;
      }
      const auto [number, job] = give_away();
      send(rank, kJob, text_of(number, job));
      ++out_, ++held_[rank];
    }
    return FeedOfJobs::is_over() && out_ == 0;
  }
  int longest_wait() const override { return static_cast<int>(kNap.count()); }

 private:
  // So many that what one rank has ahead is done before the last of them.
  bool has_plenty() const {
    constexpr std::size_t kEach = 4;
    return left() > kEach * static_cast<std::size_t>(team_.ranks_);
  }

  void take(const Letter& letter) {
    if (letter.tag == kWant) team_.hungry_.push_back(letter.rank);
    if (letter.tag == kMessage) {
      const std::size_t space = letter.text.find(' ');
      on_message_(std::stoul(letter.text.substr(0, space)), letter.text.substr(space + 1));
    }
    if (letter.tag == kEnd) {
      const Json json = parse_json(letter.text);
      --out_, --held_[letter.rank];
      on_end_(json.at("number").get<std::size_t>(), end_from(json));
    }
  }

  const MpiExecutor& team_;
  const OnMessage& on_message_;
  const OnEnd& on_end_;
  std::size_t out_ = 0;
  std::map<int, int> held_;  // by rank: jobs that it has and that have not ended
};

// Asks for jobs, always for one more than it does, and does them.
class MpiExecutor::Helping : public JobFeed {
 public:
  explicit Helping(const Work& work) : work_(work) {}

  bool is_over() override {
    while (const auto letter = next_letter()) {
      if (letter->tag == kJob) waiting_.push_back(parse_json(letter->text)), --due_;
      is_over_ |= letter->tag == kOver;
    }
    for (; !is_over_ && asked_ < 2; ++asked_, ++due_) send(kLeader, kWant);
    return is_over_;
  }
  std::optional<Numbered> next() override {
    if (waiting_.empty()) return {};
    const Json json = std::move(waiting_.front());
    waiting_.pop_front();
    const JobSpec job = job_from(json);
    return Numbered{json.at("number").get<std::size_t>(),
                    {[this, job](const Channel& channel) { work_(job, channel); }, job.limit}};
  }
  // While it has a job it need not look for letters: the job's end wakes it.
  int longest_wait() const override { return asked_ > due_ ? JobFeed::longest_wait() : static_cast<int>(kNap.count()); }

  void end(std::size_t job, const JobEnd& end) {
    --asked_;
    send(kLeader, kEnd, text_of(job, end));
  }

 private:
  const Work& work_;
  std::deque<Json> waiting_;
  int asked_ = 0;  // jobs asked for that have not ended
  int due_ = 0;    // of these, not got yet
  bool is_over_ = false;
};

MpiExecutor::MpiExecutor() {
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks_);
}

MpiExecutor::~MpiExecutor() {
  if (!leads()) return;
  for (int rank = 1; rank < ranks_; ++rank) send(rank, kOver);
  for (int left = 1; left < ranks_;) left += wait_for_letter().tag == kBye;
}

void MpiExecutor::refuse(int rank, const std::string& why) const {
  throw InputError(fmt::format("rank {} cannot take part: {}", rank, why));
}

void MpiExecutor::lead_in(const std::string& plan, const std::string& folder) const {
  std::vector<std::string> plans(static_cast<std::size_t>(ranks_));
  for (int heard = 1; heard < ranks_;) {
    Letter letter = wait_for_letter();
    if (letter.tag == kPlan) plans[static_cast<std::size_t>(letter.rank)] = std::move(letter.text), ++heard;
  }
  for (int rank = 1; rank < ranks_; ++rank) {
    const std::string& text = plans[static_cast<std::size_t>(rank)];
    if (text.starts_with("!")) refuse(rank, text.substr(1));
    if (text != hash_of(plan))
      refuse(rank, "it has planned another grid; give every rank the same program, suite and files");
  }
  const std::string sign = fmt::format("{:08x}{:08x}", std::random_device()(), std::random_device()());
  std::ofstream(std::filesystem::path(folder) / kSign) << sign;
  for (int rank = 1; rank < ranks_; ++rank) send(rank, kFolder, sign);
  for (int seen = 1; seen < ranks_;) {
    const Letter letter = wait_for_letter();
    if (letter.tag == kWant) hungry_.push_back(letter.rank);
    if (letter.tag != kSeen) continue;
    if (!letter.text.empty()) refuse(letter.rank, letter.text);
    ++seen;
  }
}

void MpiExecutor::join_in(const std::string& plan, const std::string& folder) const {
  has_told_ = true;
  send(kLeader, kPlan, hash_of(plan));
  const std::string sign = wait_for(kFolder);
  const bool is_seen = sign_in(folder) == sign;
  send(kLeader, kSeen,
       is_seen ? ""
               : fmt::format("on {} it does not see the folder '{}' of rank 0; give an --out that all machines share",
                             host(), folder));
}

void MpiExecutor::begin(const std::string& plan, const std::string& folder) const {
  leads() ? lead_in(plan, folder) : join_in(plan, folder);
}

std::string MpiExecutor::wait_for(int tag) const {
  for (;;) {
    Letter letter = wait_for_letter();
    if (letter.tag == tag) return std::move(letter.text);
    if (letter.tag == kOver) leave(), throw Dismissed();
  }
}

void MpiExecutor::leave() const {
  is_dismissed_ = true;
  send(kLeader, kBye);
}

void MpiExecutor::stay_out(const std::string& why) const {
  if (is_dismissed_) return;
  if (!has_told_) send(kLeader, kPlan, "!" + why);
  try {
    wait_for(kBye);  // which no leader says
  } catch (const Dismissed&) {
  }
}

void MpiExecutor::run(JobSource& jobs, const Work& work, const OnMessage& on_message, const OnEnd& on_end) const {
  if (leads()) {
    Leading feed(*this, jobs, work, on_message, on_end);
    return run_jobs(feed, 1, on_message, on_end);
  }
  Helping feed(work);
  run_jobs(
      feed, 1,
      [](std::size_t job, const std::string& message) { send(kLeader, kMessage, fmt::format("{} {}", job, message)); },
      [&](std::size_t job, const JobEnd& end) { feed.end(job, end); });
  leave();
  throw Dismissed();
}

}  // namespace rigor::inline cli
