#include "framework/data/noise/noise.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "framework/data/features/layout_rows.hpp"
#include "framework/experiment/noise_correlation.hpp"
#include "kernels/linalg/autocorrelation.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

/// Times that are multiples of a sample time apart, and these multiples.
struct GridRows {
  std::vector<Eigen::Index> times;
  std::vector<long> steps;
};

/// Groups the times (s) by what they leave of the last sample time.
std::vector<GridRows> collectGrids(const Eigen::VectorXd& times, double sample_time) {
  constexpr double kTolerance = 1e-5;  // of the sample time
  std::vector<GridRows> grids;
  std::vector<double> remainders;
  for (Eigen::Index i = 0; i < times.size(); ++i) {
    const double steps = times[i] / sample_time;
    const auto found = std::find_if(remainders.begin(), remainders.end(), [&](double remainder) {
      return std::abs(std::remainder(steps - remainder, 1.0)) < kTolerance;
    });
    const auto group = static_cast<std::size_t>(found - remainders.begin());
    if (found == remainders.end()) {
      remainders.push_back(steps);
      grids.emplace_back();
    }
    grids[group].times.push_back(i);
    grids[group].steps.push_back(std::lround(steps - remainders[group]));
  }
  return grids;
}

Eigen::MatrixXd makeCorrelation(const Eigen::VectorXd& rho, const std::vector<long>& steps) {
  const auto count = static_cast<Eigen::Index>(steps.size());
  return Eigen::MatrixXd::NullaryExpr(
      count, count, [&](Eigen::Index i, Eigen::Index j) { return rho[std::abs(steps[i] - steps[j])]; });
}

bool isDiagonal(const FeatureMatrix& matrix) {
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (FeatureMatrix::InnerIterator entry(matrix, row); entry; ++entry) {
      if (entry.col() != row && entry.value() != 0.0) {
        return false;
      }
    }
  }
  return true;
}

/// Without rounding.
Eigen::VectorXd calcDrawnStddev(const NoiseSpec& noise, const ResponseLayout& layout) {
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

/// Of every row, 0 where readings are not rounded; empty if none are.
Eigen::VectorXd collectQuanta(const NoiseSpec& noise, const ResponseLayout& layout) {
  Eigen::VectorXd quanta = Eigen::VectorXd::Zero(layout.getRowCount());
  for (const RoundedOutput& rounded : noise.rounded) {
    const auto& names = layout.output_names;
    const auto found = std::find(names.begin(), names.end(), rounded.name);
    if (found != names.end() && layout.times.size() > 0) {
      quanta.segment(layout.getRow(found - names.begin(), 0), layout.times.size())
          .setConstant(rounded.quantum);
    }
  }
  return (quanta.array() > 0.0).any() ? quanta : Eigen::VectorXd{};
}

Eigen::VectorXd addRounding(const Eigen::VectorXd& drawn, const Eigen::VectorXd& quanta) {
  return quanta.size() == 0 ? drawn
                            : (drawn.array().square() + quanta.array().square() / 12.0).sqrt().matrix();
}

}  // namespace

Eigen::VectorXd calcNoiseStddev(const NoiseSpec& noise, const ResponseLayout& layout) {
  return addRounding(calcDrawnStddev(noise, layout), collectQuanta(noise, layout));
}

ResponseNoise::ResponseNoise(const NoiseSpec& noise, const ResponseLayout& layout)
    : drawn_(calcDrawnStddev(noise, layout)), quanta_(collectQuanta(noise, layout)) {
  stddev_ = addRounding(drawn_, quanta_);
  for (const NoiseCorrelationSpec& spec : noise.correlation) {
    correlate(spec, layout);
  }
}

void ResponseNoise::correlate(const NoiseCorrelationSpec& spec, const ResponseLayout& layout) {
  if (!spec.sample_time) {
    return;  // no feature uses two times of the output
  }
  const Eigen::Index output = findOutput(layout, spec.name.text);
  for (const GridRows& grid : collectGrids(layout.times, *spec.sample_time)) {
    const Eigen::VectorXd rho = calcAutocorrelation(spec, grid.steps.back() - grid.steps.front());
    linalg::Cholesky factor = linalg::calcCholesky(makeCorrelation(rho, grid.steps));
    if (!factor.positive_definite) {
      throw std::invalid_argument("the noise of output '" + spec.name.text +
                                  "' is so correlated that its covariance is singular");
    }
    Block block{{}, std::move(factor.lower)};
    for (const Eigen::Index time : grid.times) {
      block.rows.push_back(layout.getRow(output, time));
    }
    blocks_.push_back(std::move(block));
  }
}

void ResponseNoise::replace(const Eigen::VectorXd& row_stddev) {
  for (const Block& block : blocks_) {
    for (const Eigen::Index row : block.rows) {
      if (row_stddev.size() > 0 && !std::isnan(row_stddev[row])) {
        throw std::invalid_argument("a row whose noise is correlated with others has none of its own");
      }
    }
  }
  for (Eigen::Index row = 0; row < row_stddev.size(); ++row) {
    drawn_[row] = std::isnan(row_stddev[row]) ? drawn_[row] : row_stddev[row];
  }
  stddev_ = addRounding(drawn_, quanta_);
}

Eigen::MatrixXd ResponseNoise::add(const Eigen::MatrixXd& responses, const RandomStream& random,
                                   std::uint64_t replicate, Eigen::Index first) const {
  Eigen::MatrixXd noisy(responses.rows(), responses.cols());
  Eigen::VectorXd normal(responses.rows());
  for (Eigen::Index sample = 0; sample < responses.cols(); ++sample) {
    random.drawNormals(static_cast<std::uint64_t>(first + sample), replicate, normal.data(),
                       static_cast<std::size_t>(normal.size()));
    for (const Block& block : blocks_) {
      const Eigen::VectorXd independent = normal(block.rows);
      normal(block.rows) = block.factor.triangularView<Eigen::Lower>() * independent;
    }
    for (Eigen::Index row = 0; row < normal.size(); ++row) {
      noisy(row, sample) = std::fma(drawn_[row], normal[row], responses(row, sample));
    }
    for (Eigen::Index row = 0; row < quanta_.size(); ++row) {
      if (quanta_[row] > 0.0) {
        noisy(row, sample) = std::nearbyint(noisy(row, sample) / quanta_[row]) * quanta_[row];
      }
    }
  }
  return noisy;
}

NoiseCovariance ResponseNoise::calcCovariance(const FeatureMatrix& matrix) const {
  const NoiseCovariance own = calcOwnCovariance(matrix);
  if (common_.cols() == 0) {
    return own;
  }
  const Eigen::MatrixXd common = matrix * common_;
  return Eigen::MatrixXd(own.toMatrix() + common * common.transpose());
}

NoiseCovariance ResponseNoise::calcOwnCovariance(const FeatureMatrix& matrix) const {
  if (blocks_.empty()) {
    const FeatureMatrix scaled = matrix * stddev_.asDiagonal();
    const FeatureMatrix product = scaled * scaled.transpose();
    return isDiagonal(product) ? NoiseCovariance::makeIndependent(product.diagonal())
                               : NoiseCovariance(Eigen::MatrixXd(product));
  }
  Eigen::MatrixXd factor = matrix * drawn_.asDiagonal();
  for (const Block& block : blocks_) {
    const Eigen::MatrixXd correlated =
        factor(Eigen::all, block.rows) * block.factor.triangularView<Eigen::Lower>();
    factor(Eigen::all, block.rows) = correlated;
  }
  Eigen::MatrixXd covariance = factor * factor.transpose();
  if (quanta_.size() > 0) {
    const FeatureMatrix rounding = matrix * (quanta_ / std::sqrt(12.0)).asDiagonal();
    covariance += rounding * rounding.transpose();
  }
  return covariance;
}

Eigen::MatrixXd addNoise(const Eigen::MatrixXd& responses, const ResponseNoise& noise,
                         const RandomStream& random, std::uint64_t replicate) {
  return noise.add(responses, random, replicate);
}

}  // namespace twinmap
