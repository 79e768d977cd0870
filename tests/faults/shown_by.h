// For each fault of the table (adapters/faults/faults.h): the case and the gates that must find it.
#pragma once

#include <map>
#include <string>

namespace rigor::test {

struct ShownBy {
  std::string of_case;
  std::string metrics;  // a regular expression: the metrics of the gates that point at it
};

const std::map<std::string, ShownBy>& shown_by();  // by the fault's name

}  // namespace rigor::test
