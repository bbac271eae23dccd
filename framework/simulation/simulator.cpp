#include "framework/simulation/simulator.hpp"

#include <fmt/core.h>

#include <stdexcept>

#include "framework/base/text/source_location.hpp"

namespace twinmap {

void Simulator::simulateWithDerivatives(const Eigen::Ref<const Eigen::MatrixXd>&, Eigen::Ref<Eigen::MatrixXd>,
                                        Eigen::MatrixXd&, SampleStatus*) {
  throw std::logic_error("Simulator::simulateWithDerivatives: this simulator has no derivatives");
}

const std::string& Simulator::getEngine() const {
  static const std::string kUnnamed;
  return kUnnamed;
}

std::string Simulator::describeEngine() const {
  const std::string& engine = getEngine();
  return engine == "lanes" ? "vectorised (built-in)" : engine;
}

void checkSampleTimes(const Eigen::VectorXd& times, double duration) {
  for (Eigen::Index i = 0; i < times.size(); ++i) {
    const bool inside = times[i] >= 0.0 && times[i] <= duration;
    if (!inside || (i > 0 && times[i] <= times[i - 1])) {
      throw ExperimentError(fmt::format(
          "sample time {:f} s must lie within the simulation's duration and after the one before", times[i]));
    }
  }
}

}  // namespace twinmap
