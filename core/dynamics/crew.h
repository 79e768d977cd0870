// Threads that do the same work on different bodies. Which member does which changes no bit of the result: no member
// reads what another writes.
#pragma once

#include <barrier>
#include <functional>
#include <thread>
#include <vector>

namespace rigor {

class Crew {
 public:
  explicit Crew(int members);  // of which the thread that calls is one
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  std::size_t members() const { return helpers_.size() + 1; }
  // Calls task(member) in each member's thread; returns when all have done.
  void run(const std::function<void(std::size_t member)>& task);

 private:
  void help(std::size_t member);

  std::barrier<> begin_, end_;
  const std::function<void(std::size_t)>* task_ = nullptr;  // null: the crew is dismissed
  std::vector<std::thread> helpers_;
};

}  // namespace rigor
