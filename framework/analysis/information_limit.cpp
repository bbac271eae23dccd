#include "framework/analysis/information_limit.hpp"

#include <limits>
#include <optional>
#include <stdexcept>

#include "framework/data/sensitivity/fisher_information.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The noise of each sample's features; of linear ones it is the same for all.
class NoiseOfSamples {
 public:
  explicit NoiseOfSamples(const FeatureNoise& noise) : noise_(noise) {}

  void update(const VectorXd& response) {
    if (!whitener_ || !noise_.isConstant()) {
      const NoiseCovariance covariance = noise_.calcCovariance(response);
      stddev_ = covariance.diagonal().cwiseSqrt();
      whitener_.emplace(covariance);
    }
  }
  const NoiseWhitener& getWhitener() const { return *whitener_; }
  const VectorXd& getStddev() const { return stddev_; }

 private:
  const FeatureNoise& noise_;
  std::optional<NoiseWhitener> whitener_;
  VectorXd stddev_;
};

}  // namespace

MatrixXd InformationLimit::calcCovariance(std::size_t sample) const {
  return prior.empty() ? calcLimitCovariance(information[sample])
                       : calcLimitCovariance(information[sample], prior[sample]);
}

MatrixXd InformationLimit::calcPriorCovariance() const {
  const Index p = mean_information.rows();
  if (prior.empty()) {
    return kUniformStddev * kUniformStddev * MatrixXd::Identity(p, p);
  }
  MatrixXd sum = MatrixXd::Zero(p, p);
  for (const MatrixXd& one : prior) {
    sum += one.size() > 0 ? calcLimitCovariance(MatrixXd::Zero(p, p), one) : MatrixXd::Zero(p, p);
  }
  return sum / static_cast<double>(static_cast<int>(prior.size()) - failures);
}

InformationLimit calcInformationLimit(const std::vector<LocalModel>& models, const FeatureNoise& noise,
                                      const std::vector<ParameterSpec>& parameters,
                                      const std::vector<MatrixXd>& prior) {
  const VectorXd widths = calcWidths(parameters);
  const Index p = widths.size(), n = static_cast<Index>(models.size());
  InformationLimit limit;
  limit.stddev.setConstant(p, n, std::numeric_limits<double>::quiet_NaN());
  limit.mean_information.setZero(p, p);
  limit.mean_covariance.setZero(p, p);
  limit.information.resize(models.size());
  limit.prior.resize(prior.size());
  NoiseOfSamples noise_of_samples(noise);
  for (Index i = 0; i < n; ++i) {
    const LocalModel& model = models[i];
    if (!model.status.ok) {
      ++limit.failures;
      continue;
    }
    noise_of_samples.update(model.response);
    const auto sample = static_cast<std::size_t>(i);
    const MatrixXd whole = calcFisherInformation(noise_of_samples.getWhitener(), model.sensitivities);
    if (!prior.empty()) {
      limit.prior[sample] = calcMarginalPrior(prior[sample], p);
    }
    limit.information[sample] =
        prior.empty() ? calcMarginalInformation(whole, p) : calcMarginalInformation(whole, p, prior[sample]);
    const MatrixXd& information = limit.information[sample];
    const MatrixXd covariance = limit.calcCovariance(sample);
    limit.stddev.col(i) = covariance.diagonal().cwiseSqrt().cwiseProduct(widths);
    limit.mean_information += information;
    limit.mean_covariance += covariance;
    const MatrixXd relevance =
        (model.sensitivities.leftCols(p).array().colwise() / noise_of_samples.getStddev().array()).square();
    limit.relevance = limit.relevance.size() == 0 ? relevance : MatrixXd(limit.relevance + relevance);
  }
  const auto successful = static_cast<double>(n - limit.failures);
  if (successful == 0.0) {
    throw std::runtime_error(
        "the information limit cannot be computed: every sample failed, the first with: " +
        models.front().status.reason);
  }
  limit.mean_information /= successful;
  limit.mean_covariance /= successful;
  limit.relevance = (limit.relevance / successful).cwiseSqrt();
  return limit;
}

}  // namespace twinmap
