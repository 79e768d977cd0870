#include "adapters/dart/dart_constants.h"

#include <dart/constraint/ContactConstraint.hpp>
#include <dart/constraint/DynamicJointConstraint.hpp>
#include <iostream>

namespace rigor::inline adapters::dart_library {

using Contact = ::dart::constraint::ContactConstraint;
using Loop = ::dart::constraint::DynamicJointConstraint;

Constants constants_in_force() {
  return {Contact::getErrorReductionParameter(), Contact::getMaxErrorReductionVelocity(),
          Contact::getConstraintForceMixing(), Loop::getErrorReductionParameter(), Loop::getConstraintForceMixing()};
}

void set_constants(const Constants& constants) {
  Contact::setErrorReductionParameter(constants.contact_erp);
  Contact::setMaxErrorReductionVelocity(constants.contact_speed);
  Contact::setConstraintForceMixing(constants.contact_cfm);
  Loop::setErrorReductionParameter(constants.loop_erp);
  Loop::setConstraintForceMixing(constants.loop_cfm);
}

Messages::Messages() : cerr_(std::cerr.rdbuf(text_.rdbuf())), cout_(std::cout.rdbuf(text_.rdbuf())) {}

Messages::~Messages() { std::cerr.rdbuf(cerr_), std::cout.rdbuf(cout_); }

std::string Messages::first() const {
  std::string line, plain;
  std::istringstream lines(text_.str());
  while (line.empty() && std::getline(lines, line)) continue;
  for (std::size_t i = 0; i < line.size(); ++i) {  // a colour is ESC [ … m
    if (line[i] != '\033') {
      plain += line[i];
    } else {
      i = std::min(line.find('m', i), line.size());
    }
  }
  return plain;
}

}  // namespace rigor::inline adapters::dart_library
