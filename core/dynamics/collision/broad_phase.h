// Finds which of many boxes along W's axes overlap, in N log N time. A tree of boxes (box_tree.h) is searched for each
// box. If most boxes stay unchanged, only the changed ones are searched. Threads may share the searches.
#pragma once

#include <utility>
#include <vector>

#include "core/base/thread_pool.h"
#include "core/dynamics/collision/box_tree.h"

namespace rigor::inline dynamics {

class BroadPhase {
 public:
  // Each pair (first < second by their place in `boxes`) that overlaps, in ascending order. A box that is not a number
  // overlaps all.
  const std::vector<std::pair<int, int>>& overlaps(const std::vector<Aabb>& boxes);
  // The same if only the boxes at these places have changed since the last call. Only these are searched, and threads
  // may share the work.
  const std::vector<std::pair<int, int>>& overlaps(const std::vector<Aabb>& boxes, const std::vector<int>& changed,
                                                   ThreadPool* threads = nullptr);

 private:
  using Pairs = std::vector<std::pair<int, int>>;
  struct alignas(kCacheLine) Part {  // the pairs that one thread finds
    BoxTree::Scratch scratch;
    Pairs found;
  };
  void search(int place, const std::vector<Aabb>& boxes, Part& part) const;
  void sort_found();
  void merge();

  BoxTree tree_;
  std::vector<int> all_;                 // places
  std::vector<char> is_changed_;         // by place
  std::vector<Part> parts_;              // by thread
  std::vector<std::size_t> first_pair_;  // by place of the first of both, among those found
  Pairs pairs_, kept_, found_;
};

}  // namespace rigor::inline dynamics
