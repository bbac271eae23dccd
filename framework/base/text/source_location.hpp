#pragma once

#include <memory>
#include <stdexcept>
#include <string>

namespace twinmap {

/// Where a value of the experiment came from: a place in a file, or an override on the command line.
struct SourceLocation {
  std::string file;      ///< file name as the user gave it, or "command line"
  int line = 0;          ///< 1-based; 0 on the command line
  int column = 0;        ///< 1-based; 0 on the command line
  std::string key_path;  ///< "system.bodies.beam1.mass", "system.springs[0].stiffness"
};

/// "file:line:column: key.path"; parts that are unknown are left out.
std::string toString(const SourceLocation& where);

/// What is wrong with an input, in parts.
struct InputProblem {
  SourceLocation where;
  std::string value;  ///< as found; "" where none is to be shown
  std::string rule;   ///< that it breaks
};

/// Wrong input. The message names file:line:column, key path, the value found (its beginning) and the rule it
/// breaks.
class ExperimentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  ExperimentError(const SourceLocation& where, const std::string& value, const std::string& rule);

  /// The parts of the message; null where it was made as one.
  const InputProblem* getProblem() const { return problem_.get(); }

 private:
  std::shared_ptr<const InputProblem> problem_;  // shared, as copies of exceptions must not throw
};

}  // namespace twinmap
