#include "framework/features/noise.hpp"

#include <algorithm>
#include <stdexcept>

namespace twinmap {

Eigen::VectorXd calcNoiseStddev(const NoiseSpec& noise, const ResponseLayout& layout) {
  Eigen::VectorXd stddev(layout.getRowCount());
  if (layout.modes > 0) {
    if (!noise.modes) {
      throw std::invalid_argument("no noise is given for the modes");
    }
    stddev.segment(layout.getFrequencyRow(0), layout.modes).setConstant(noise.scale * noise.modes->frequency);
    stddev.segment(layout.getDampingRow(0), layout.modes)
        .setConstant(noise.scale * noise.modes->damping_ratio);
  }
  for (Eigen::Index o = 0; o < layout.getOutputCount() && layout.times.size() > 0; ++o) {
    const std::string& output = layout.output_names[o];
    const auto found = std::find_if(noise.stddev.begin(), noise.stddev.end(),
                                    [&](const OutputNoiseSpec& spec) { return spec.name.text == output; });
    if (found == noise.stddev.end()) {
      throw std::invalid_argument("no noise is given for output '" + output + "'");
    }
    stddev.segment(layout.getRow(o, 0), layout.times.size()).setConstant(noise.scale * found->stddev);
  }
  return stddev;
}

Eigen::MatrixXd addNoise(const Eigen::MatrixXd& responses, const Eigen::VectorXd& row_stddev,
                         const RandomStream& random, int replicate) {
  return Eigen::MatrixXd::NullaryExpr(
      responses.rows(), responses.cols(), [&](Eigen::Index row, Eigen::Index sample) {
        return responses(row, sample) + row_stddev[row] * random.calcNormal(sample, row, replicate);
      });
}

}  // namespace twinmap
