// A row of a table of bad input: the text, and what the message about it must say.
#pragma once

#include <boost/test/unit_test.hpp>
#include <functional>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace rigor {

struct Refusal {
  std::string text;
  std::string start;               // of the message: "line:column: key: "
  std::vector<std::string> parts;  // of the rest of it
};

// The message with which `read` refuses; empty if it does not.
inline std::string refusal_of(const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline void check_refusal(const Refusal& expected, const std::string& path, const std::function<void()>& read) {
  BOOST_TEST_CONTEXT("input:\n" << expected.text.substr(0, 2000)) {
    const std::string message = refusal_of(read);
    BOOST_TEST_CONTEXT("message: " << message) {
      const std::string start = path + ":" + expected.start;
      BOOST_TEST(message.substr(0, start.size()) == start);
      for (const std::string& part : expected.parts) {
        BOOST_TEST_CONTEXT("wanted: " << part) { BOOST_TEST((message.find(part) != std::string::npos)); }
      }
    }
  }
}

}  // namespace rigor
