#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "framework/base/text/source_location.hpp"

namespace twinmap {

/// Why one sample cannot be simulated: "body 'beam1': mass = 0 kg must be positive". Thrown while a sample is
/// prepared or run; a simulator turns it into that sample's status.
class SimulationFailure : public std::runtime_error {
 public:
  /// `where`: the number of the experiment that is the cause, where it is known.
  explicit SimulationFailure(const std::string& reason, SourceLocation where = {})
      : std::runtime_error(reason), where_(std::move(where)) {}

  const SourceLocation& getWhere() const { return where_; }

 private:
  SourceLocation where_;
};

/// How messages call a number: "<owner>: <name> = 0 <unit>".
struct Quantity {
  const std::string& owner;  ///< "body 'beam1'"
  const char* name;          ///< "mass"
  const char* unit;          ///< "kg"
};

/// Throws SimulationFailure("<owner>: <name> = <value> <unit> <rule>"); `where` the value is given.
[[noreturn]] void throwUnusable(const Quantity& quantity, double value, const std::string& rule,
                                const SourceLocation& where);

}  // namespace twinmap
