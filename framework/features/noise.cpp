#include "framework/features/noise.hpp"

#include <algorithm>
#include <stdexcept>

namespace twinmap {

Eigen::VectorXd collectNoiseStddev(const NoiseSpec& noise, const std::vector<OutputSpec>& outputs) {
  Eigen::VectorXd stddev(outputs.size());
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    const auto found =
        std::find_if(noise.stddev.begin(), noise.stddev.end(),
                     [&](const OutputNoiseSpec& spec) { return spec.name.text == outputs[o].name.text; });
    if (found == noise.stddev.end()) {
      throw std::invalid_argument("no noise is given for output '" + outputs[o].name.text + "'");
    }
    stddev[static_cast<Eigen::Index>(o)] = noise.scale * found->stddev;
  }
  return stddev;
}

Eigen::MatrixXd addNoise(const Eigen::MatrixXd& responses, const Eigen::VectorXd& stddev_of_output,
                         const RandomStream& random, int replicate) {
  const Eigen::Index times = responses.rows() / stddev_of_output.size();
  return Eigen::MatrixXd::NullaryExpr(
      responses.rows(), responses.cols(), [&](Eigen::Index row, Eigen::Index sample) {
        return responses(row, sample) +
               stddev_of_output[row / times] * random.calcNormal(sample, row, replicate);
      });
}

}  // namespace twinmap
