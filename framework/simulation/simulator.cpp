#include "framework/simulation/simulator.hpp"

#include <stdexcept>

namespace twinmap {

void Simulator::simulateWithDerivatives(const Eigen::Ref<const Eigen::MatrixXd>&, Eigen::Ref<Eigen::MatrixXd>,
                                        Eigen::MatrixXd&, SampleStatus*) {
  throw std::logic_error("Simulator::simulateWithDerivatives: this simulator has no derivatives");
}

const std::string& Simulator::getEngine() const {
  static const std::string kUnnamed;
  return kUnnamed;
}

}  // namespace twinmap
