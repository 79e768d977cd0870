// What a robot's file says and its import does not, as data.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace rigor::inline scene {

enum class LossKind {
  visual,    // changes no motion: what is only drawn, measured or controlled from outside
  assumed,   // the file leaves it open, or sets one solver: the import chooses
  physical,  // changes the motion
};
std::string word_of(LossKind kind);

struct Reason {
  LossKind kind = LossKind::physical;
  std::string text;
};
inline Reason no_motion(std::string text) { return {LossKind::visual, std::move(text)}; }
inline Reason assumed(std::string text) { return {LossKind::assumed, std::move(text)}; }
inline Reason lost(std::string text) { return {LossKind::physical, std::move(text)}; }

// Equal losses of a file: what is left out, why, and where.
struct Loss {
  LossKind kind = LossKind::physical;
  std::string what, why;
  std::vector<std::string> places;  // "file:line: link 'arm'"; the first few
  std::size_t count = 0;            // of all places
};

class LeftOut {
 public:
  static constexpr std::size_t kPlaces = 20, kMostKinds = 1000;

  // `where`: "file:line: link 'arm'". Throws InputError beyond kMostKinds.
  void add(const std::string& where, const std::string& what, const Reason& reason);
  const std::vector<Loss>& all() const { return losses_; }  // in the order in which they were met
  std::vector<std::string> sentences() const;               // one for each place

 private:
  std::vector<Loss> losses_;
  std::map<std::pair<std::string, std::string>, std::size_t> index_;
};

// Those of a kind.
std::vector<Loss> losses_of(const std::vector<Loss>& losses, LossKind kind);
// "armature: why (3 times, first at humanoid.xml:45: joint 'hip')".
std::string sentence_of(const Loss& loss);
// "not the same robot: armature (3 times), range", of the physical ones; "" without any.
std::string not_the_same_robot(const std::vector<Loss>& losses);

}  // namespace rigor::inline scene
