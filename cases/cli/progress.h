// A bar on stderr while cells run, if stderr is a terminal.
#pragma once

#include <cstddef>

namespace rigor {

class Progress {
 public:
  Progress();
  ~Progress();  // wipes the bar
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void show(std::size_t done, std::size_t all);

 private:
  bool is_terminal_, has_colour_;
};

}  // namespace rigor
