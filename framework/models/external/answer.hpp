#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/simulation/response_layout.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// The program answered what is not an answer, so that nothing is known of what it will do next.
class ProtocolError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The answer to the first line, human-readable.
std::string writeHelloAnswer();

/// Checks a program's answer to the first line. Throws ProtocolError for another version of the protocol.
void checkHello(const std::string& line);

/// Reads the answer to one sample, {"outputs": {name: [values]}} or {"failed": reason}, into `response` (rows
/// of the layout). `names`: of the outputs. A wrong number of values and what is not finite is a failure of
/// the sample. Throws ProtocolError for what is no such line.
SampleStatus readAnswer(const std::string& line, const std::vector<std::string>& names,
                        const ResponseLayout& layout, Eigen::Ref<Eigen::VectorXd> response);

/// The same for a batch, {"samples": [...]}, into as many columns and statuses.
void readAnswers(const std::string& line, const std::vector<std::string>& names, const ResponseLayout& layout,
                 Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses);

}  // namespace twinmap
