#include "core/dynamics/crew.h"

namespace rigor {

Crew::Crew(int members) : begin_(members), end_(members) {
  for (int k = 1; k < members; ++k) helpers_.emplace_back([this, k] { help(static_cast<std::size_t>(k)); });
}

Crew::~Crew() {
  task_ = nullptr;
  begin_.arrive_and_wait();
  for (std::thread& helper : helpers_) helper.join();
}

void Crew::run(const std::function<void(std::size_t)>& task) {
  task_ = &task;
  begin_.arrive_and_wait();
  task(0);
  end_.arrive_and_wait();
}

void Crew::help(std::size_t member) {
  for (;;) {
    begin_.arrive_and_wait();
    if (!task_) return;
    (*task_)(member);
    end_.arrive_and_wait();
  }
}

}  // namespace rigor
