#include "framework/estimation/posterior/noise/noise_candidates.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/complement.hpp>
#include <cmath>

#include "framework/estimation/bounded_information.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/estimation/posterior/noise/colour_fit.hpp"
#include "framework/estimation/posterior/noise/outlier_loss.hpp"
#include "framework/estimation/posterior/noise/residual_loss.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Makes hypotheses of one measurement's noise and tries them.
class Candidates {
 public:
  Candidates(const NoiseHypothesis& stated, const LinearFit& fit)
      : stated_(stated), fit_(fit), window_(fit.model->getWhole()) {
    for (const Index feature : window_.features) {
      infos_.push_back(fit.model->getExtractor().getInfos()[static_cast<std::size_t>(feature)]);
    }
    for (const FeatureInfo& info : infos_) {
      if (info.isSample() && std::find(outputs_.begin(), outputs_.end(), info.output) == outputs_.end()) {
        outputs_.push_back(info.output);
      }
    }
  }

  std::vector<NoiseHypothesis> list() {
    std::vector<NoiseHypothesis> listed{supposeOutliers()};
    if (!window_.whitener || fit_.residual.size() != static_cast<Index>(infos_.size())) {
      return listed;
    }
    const auto add = [&](const NoiseHypothesis& hypothesis) {
      if (explains(hypothesis)) {
        listed.push_back(hypothesis);
      }
    };
    const NoiseHypothesis sizes = supposeSizes();
    add(sizes);
    if (std::any_of(outputs_.begin(), outputs_.end(), [&](int output) { return getStated(output).factor; })) {
      listed.push_back(sizes);  // untried, as outliers are: a fit that they drew says nothing about them
      listed.back().has_outliers = true;
    }
    const NoiseHypothesis offsets = supposeOffsets(sizes);
    const bool coloured = settle(stated_).whiteness_p < kMismatchLevel;
    // coloured noise has a mean that looks like an offset where it is taken for white
    const NoiseHypothesis both = coloured ? supposeColours(offsets) : offsets;
    const std::vector<int> kept = findOffsets(both);
    if (!kept.empty()) {
      add(keepOffsets(supposeOffsets(stated_), kept));
      add(keepOffsets(offsets, kept));
    }
    if (coloured) {
      if (const NoiseHypothesis colours = supposeColours(sizes); hasColours(colours)) {
        add(colours);
      }
    }
    if (hasColours(both) && !kept.empty()) {
      add(keepOffsets(both, kept));
    }
    return listed;
  }

 private:
  OutputNoise getStated(int output) const {
    for (const OutputNoise& noise : stated_.outputs) {
      if (noise.output == output) {
        return noise;
      }
    }
    return {output};
  }

  NoiseHypothesis supposeOutliers() const {
    NoiseHypothesis hypothesis = stated_;
    hypothesis.has_outliers = true;
    return hypothesis;
  }

  NoiseHypothesis makeEmpty() const {
    NoiseHypothesis hypothesis;
    hypothesis.censored = stated_.censored;
    return hypothesis;
  }

  static bool hasColours(const NoiseHypothesis& hypothesis) {
    return std::any_of(hypothesis.outputs.begin(), hypothesis.outputs.end(),
                       [](const OutputNoise& noise) { return !noise.colours.empty(); });
  }

  /// Every output of unknown size.
  NoiseHypothesis supposeSizes() const {
    NoiseHypothesis hypothesis = makeEmpty();
    for (const int output : outputs_) {
      hypothesis.outputs.push_back(getStated(output));
      hypothesis.outputs.back().factor.reset();
    }
    return hypothesis;
  }

  NoiseHypothesis supposeOffsets(const NoiseHypothesis& from) const {
    NoiseHypothesis hypothesis = makeEmpty();
    for (const int output : outputs_) {
      const auto found = std::find_if(from.outputs.begin(), from.outputs.end(),
                                      [&](const OutputNoise& noise) { return noise.output == output; });
      hypothesis.outputs.push_back(found == from.outputs.end() ? OutputNoise{output} : *found);
      hypothesis.outputs.back().has_offset = true;
    }
    return hypothesis;
  }

  static NoiseHypothesis keepOffsets(NoiseHypothesis hypothesis, const std::vector<int>& outputs) {
    for (OutputNoise& noise : hypothesis.outputs) {
      noise.has_offset = std::find(outputs.begin(), outputs.end(), noise.output) != outputs.end();
    }
    return hypothesis;
  }

  NoiseHypothesis supposeColours(NoiseHypothesis hypothesis) const {
    for (OutputNoise& noise : hypothesis.outputs) {
      const OutputSamples samples = findSamples(*fit_.model, window_, noise.output, stated_.censored);
      const Index u = fit_.jacobian.cols();
      ResidualSeries series{fit_.residual(samples.rows),
                            MatrixXd(static_cast<Index>(samples.rows.size()), u + (noise.has_offset ? 1 : 0)),
                            samples.lags};
      series.regressors.leftCols(u) = fit_.jacobian(samples.rows, Eigen::all);
      if (noise.has_offset) {
        series.regressors.col(u) = makeOffset(window_, samples);
      }
      noise.colours = fitColours(series);
      if (noise.colours.empty()) {
        noise.factor = getStated(noise.output).factor;
      }
    }
    return hypothesis;
  }

  /// The residual about the best point of the linear model under a hypothesis.
  ResidualLoss::Standardized adjust(const NoiseHypothesis& hypothesis) const {
    const ResidualLoss loss(hypothesis, *fit_.model, window_);
    const Index u = fit_.jacobian.cols();
    VectorXd at = VectorXd::Zero(u);
    double degrees = 1.0;
    for (int i = 0; i < kFewIterations; ++i) {
      const LinearLoss linear = loss.linearize(fit_.residual - fit_.jacobian * at, fit_.jacobian);
      const BoundedInformation information(linear.information);
      at += information.solve(linear.descent - kHalfWidthInformation * at);
      degrees = calcDegrees(fit_.residual.size(), information);
    }
    return loss.standardize(fit_.residual - fit_.jacobian * at, fit_.jacobian, degrees);
  }

  ResidualTest settle(const NoiseHypothesis& hypothesis) const {
    const ResidualLoss::Standardized adjusted = adjust(hypothesis);
    std::vector<Index> tested;
    std::vector<FeatureInfo> infos;
    for (Index i = 0; i < adjusted.residual.size(); ++i) {
      if (std::isfinite(adjusted.residual[i])) {
        tested.push_back(i);
        infos.push_back(infos_[static_cast<std::size_t>(i)]);
      }
    }
    return testResidual(adjusted.residual(tested), adjusted.degrees, infos);
  }

  /// Whether it is worth sampling: the linear model is not exact.
  bool explains(const NoiseHypothesis& hypothesis) const {
    constexpr double kHopeless = 1e-5;
    return settle(hypothesis).calcPValue() > kHopeless;
  }

  std::vector<int> findOffsets(const NoiseHypothesis& hypothesis) const {
    std::vector<int> outputs;
    for (const FoundNoise& noise : adjust(hypothesis).noise) {
      if (noise.has_offset && std::abs(noise.offset) > kRareDeviations * noise.offset_stddev) {
        outputs.push_back(noise.output);
      }
    }
    return outputs;
  }

  const NoiseHypothesis& stated_;
  const LinearFit& fit_;
  const GrowingWindow& window_;
  std::vector<FeatureInfo> infos_;
  std::vector<int> outputs_;
};

}  // namespace

std::vector<NoiseHypothesis> listNoiseHypotheses(const NoiseHypothesis& stated, const LinearFit& fit) {
  return Candidates(stated, fit).list();
}

NoiseHypothesis guessSizes(NoiseHypothesis stated, const RefinementModel& model, const VectorXd& features) {
  const GrowingWindow& window = model.getWhole();
  const VectorXd fitted = model.convert(features)(window.features);
  for (OutputNoise& noise : stated.outputs) {
    const VectorXd values = fitted(findSamples(model, window, noise.output).rows);
    const Index n = values.size();
    if (noise.factor || n < 3) {
      continue;
    }
    const VectorXd bends = values.head(n - 2) - 2.0 * values.segment(1, n - 2) + values.tail(n - 2);
    const double mean_square = values.squaredNorm() / static_cast<double>(n);
    // samples that were rounded to a few levels have next to none
    noise.factor = std::max({calcRobustSize(bends) / std::sqrt(6.0), kSameNumber * std::sqrt(mean_square),
                             std::numeric_limits<double>::min()});
  }
  return stated;
}

bool isLargerThanStated(const FoundNoise& noise) {
  const double n = noise.effective_samples;
  return cdf(complement(boost::math::chi_squared(n), n * noise.factor * noise.factor)) < kRareLevel;
}

double calcSizeDeviation(const FoundNoise& noise) {
  return std::log(noise.factor) * std::sqrt(2.0 * noise.effective_samples);
}

}  // namespace twinmap
