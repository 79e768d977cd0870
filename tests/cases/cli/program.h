// The program itself, run as a process in a folder of the test. For files to which RIGOR_PROGRAM is told.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/folder.h"

namespace rigor {

struct Program {
  struct Answer {
    int code;
    std::string out, err;
  };
  Folder folder;

  std::string path(const std::string& name) const { return (folder.path / name).string(); }
  std::string content(const std::string& name) const {
    std::ifstream stream(folder.path / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  // In the folder, which names of files are from.
  Answer run(const std::vector<std::string>& words) const {
    std::string command = "cd '" + folder.path.string() + "' && '" RIGOR_PROGRAM "'";
    for (const std::string& word : words) command += " '" + word + "'";
    const int status = std::system((command + " >stdout 2>stderr").c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content("stdout"), content("stderr")};
  }
};

}  // namespace rigor
