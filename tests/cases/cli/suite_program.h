// The program on a suite of its own, of two cases of which one cannot meet its gate, in a folder of the test; it can be
// started, killed and waited for. For files to which RIGOR_PROGRAM is told.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "generated/tests/places.h"
#include "tests/folder.h"

namespace rigor::test {

namespace fs = std::filesystem;

inline constexpr const char* kFalling = R"(title = "A stone thrown"
source = "any book"
[scene]
gravity = [0, -10, 0]
[[scene.body]]
name = "stone, big"
mass = 2
inertia = [1, 1, 1]
velocity = [1, 0, 0]
[run]
duration = 1
dt = ["1/10", "1/20"]
[truth]
kind = "projectile"
[[gate]]
metric = "position_error"
engines = ["core:rk4"]
max = %MAX%
because = "exact for a parabola, up to rounding"
)";

inline std::string text_with(const std::string& limit) {
  std::string text = kFalling;
  return text.replace(text.find("%MAX%"), 5, limit);
}

inline std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

struct Answer {
  int code;  // -signal if it was killed
  std::string out, err;
};

// A suite of two cases, and the program started on it.
struct SuiteProgram {
  Folder folder;
  std::string suite = (folder.path / "suite").string(), out = (folder.path / "out").string();

  SuiteProgram() {
    folder.write("suite/air/stone.toml", text_with("1e-9"));
    folder.write("suite/air/strict.toml", text_with("1e-30"));
  }

  // `before`: what the process does to itself before it becomes the program.
  pid_t start(
      std::vector<std::string> words, const std::function<void()>& before = [] {},
      const std::string& program = RIGOR_PROGRAM) const {
    words.insert(words.begin(), program);
    const bool takes_suite =
        words.size() > 1 && words[1] != "compare" && words[1] != "baseline" && words[1] != "settle";
    if (takes_suite && !words[1].starts_with("-")) words.insert(words.end(), {"--suite", suite});
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const std::string stdout_file = (folder.path / "stdout").string(), stderr_file = (folder.path / "stderr").string();
    const pid_t pid = fork();
    if (pid != 0) return pid;
    setpgid(0, 0);
    dup2(open(stdout_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
    dup2(open(stderr_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    for (int signal = 1; signal < NSIG; ++signal) ::signal(signal, SIG_DFL);
    before();
    execv(argv[0], argv.data());
    _exit(127);
  }
  Answer wait_for(pid_t pid) const {
    int status = 0;
    waitpid(pid, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), content(folder.path / "stdout"),
            content(folder.path / "stderr")};
  }
  Answer run(
      const std::vector<std::string>& words, const std::function<void()>& before = [] {}) const {
    return wait_for(start(words, before));
  }
  // Through a shell, with `around` in place of the program's own words: "%s | true".
  int shell(const std::string& around, const std::string& words) const {
    std::string command = around;
    command.replace(command.find("%s"), 2,
                    std::string(RIGOR_PROGRAM) + " " + words + " --suite " + suite + " --out " + out);
    const int answer = std::system(("bash -o pipefail -c '" + command + "'").c_str());
    return WIFEXITED(answer) ? WEXITSTATUS(answer) : -1;
  }
  nlohmann::json results() const { return nlohmann::json::parse(content(fs::path(out) / "results.json")); }
  nlohmann::json cells() const { return results().at("cells"); }
};

inline std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace rigor::test
