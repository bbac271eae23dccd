#include "framework/analysis/exact_posterior.hpp"

#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>

#include "framework/data/sensitivity/fisher_information.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/point_set.hpp"
#include "framework/simulation/simulator_team.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "kernels/sampling/weighted_draws.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using importance::calcCovariance;
using importance::calcMean;
using importance::WeightedDraws;

/// A normal distribution over the unit box.
struct Proposal {
  VectorXd mean;
  MatrixXd factor;  ///< lower Cholesky factor of the covariance
};

class Box {
 public:
  explicit Box(const std::vector<ParameterSpec>& parameters)
      : lower_(calcLowerBounds(parameters)), width_(calcWidths(parameters)) {}

  VectorXd toUnit(const VectorXd& point) const { return (point - lower_).cwiseQuotient(width_); }
  VectorXd fromUnit(const VectorXd& unit) const { return lower_ + width_.cwiseProduct(unit); }
  const VectorXd& getWidth() const { return width_; }

 private:
  VectorXd lower_, width_;
};

/// Standard normal numbers, p x n, evenly spread.
MatrixXd sampleNormals(Index dimensions, int draws, std::uint64_t seed) {
  PointSetSpec sobol;
  sobol.method = DesignMethod::kSobol;
  sobol.samples = draws;
  const boost::math::normal standard;
  return sampleUnitCube(sobol, static_cast<int>(dimensions), seed, RandomPurpose::kPosterior)
      .unaryExpr(
          [&](double u) { return boost::math::quantile(standard, std::min(std::max(u, 1e-15), 1 - 1e-15)); });
}

/// Log likelihood at a point of the unit box, -infinity outside and where the simulation fails.
double calcLogLikelihood(Simulator& simulator, const LeastSquaresProblem& problem, const Box& box,
                         const VectorXd& unit) {
  constexpr double kImpossible = -std::numeric_limits<double>::infinity();
  if (unit.minCoeff() < 0.0 || unit.maxCoeff() > 1.0) {
    return kImpossible;
  }
  MatrixXd response(simulator.getLayout().getRowCount(), 1);
  SampleStatus status;
  simulator.simulate(problem.makePoint(box.fromUnit(unit)), response, &status);
  const VectorXd residual =
      problem.noise.apply(problem.extractor.extract(response).col(0) - problem.measured);
  return status.ok && residual.allFinite() ? -0.5 * residual.squaredNorm() : kImpossible;
}

WeightedDraws draw(Simulator& simulator, const LeastSquaresProblem& problem, const Box& box,
                   const Proposal& proposal, const MatrixXd& normals) {
  const MatrixXd points = (proposal.factor * normals).colwise() + proposal.mean;
  VectorXd log_weights(normals.cols());
  for (Index i = 0; i < normals.cols(); ++i) {
    log_weights[i] =
        calcLogLikelihood(simulator, problem, box, points.col(i)) + 0.5 * normals.col(i).squaredNorm();
  }
  return importance::weigh(points, log_weights);
}

Proposal makeProposal(const VectorXd& mean, const MatrixXd& covariance) {
  constexpr double kWidening = 1.25;
  constexpr double kFloor = 1e-16;  // of the box's squared width
  const MatrixXd floor = kFloor * MatrixXd::Identity(mean.size(), mean.size());
  return {mean, kWidening * linalg::calcCholesky(covariance + floor).lower};
}

}  // namespace

ExactPosterior calcExactPosterior(Simulator& simulator, const LeastSquaresProblem& problem,
                                  const VectorXd& start, int sample, const PosteriorOptions& options) {
  constexpr int kMaxFitSimulations = 1000, kRounds = 4;
  constexpr double kEnough = 0.2;  // of the draws
  const Box box(problem.parameters);
  const Index p = start.size();
  ExactPosterior posterior;
  posterior.mean.setConstant(p, std::numeric_limits<double>::quiet_NaN());
  posterior.stddev = posterior.mean;
  const LeastSquaresFit fit = fitLeastSquares(simulator, problem, start, kMaxFitSimulations);
  posterior.simulations = fit.simulations;
  if (!fit.converged) {
    posterior.warning = "the least-squares fit did not converge: " + fit.message;
    return posterior;
  }
  const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(sample);
  const MatrixXd normals = sampleNormals(p, options.draws, seed);
  Proposal proposal = makeProposal(box.toUnit(fit.parameters), calcLimitCovariance(fit.information));
  WeightedDraws draws;
  double effective_sample_size = 0.0;
  for (int round = 0; round < kRounds && effective_sample_size < kEnough * options.draws; ++round) {
    if (round > 0) {
      proposal = makeProposal(calcMean(draws), calcCovariance(draws));
    }
    draws = draw(simulator, problem, box, proposal, normals);
    effective_sample_size = importance::calcEffectiveSampleSize(draws);
    posterior.simulations += options.draws;
  }
  posterior.effective_sample_size = effective_sample_size;
  if (!(effective_sample_size >= importance::kSmallestSampleSize)) {
    posterior.warning = "the effective sample size stayed below 100";
    return posterior;
  }
  posterior.mean = box.fromUnit(calcMean(draws));
  posterior.stddev = calcCovariance(draws).diagonal().cwiseSqrt().cwiseProduct(box.getWidth());
  return posterior;
}

std::vector<ExactPosterior> calcExactPosteriors(const Simulator& prototype, const FeatureExtractor& extractor,
                                                const NoiseWhitener& noise,
                                                const std::vector<ParameterSpec>& parameters,
                                                const PosteriorQuestions& questions,
                                                const PosteriorOptions& options) {
  const int count = static_cast<int>(questions.features.cols());
  std::vector<ExactPosterior> posteriors(count);
  runOnTeam(prototype, count, options.threads, [&](Simulator& simulator, int i) {
    const VectorXd features = questions.features.col(i);
    const VectorXd known = questions.inputs.rows() > 0 ? VectorXd(questions.inputs.col(i)) : VectorXd();
    posteriors[i] = calcExactPosterior(simulator, {extractor, noise, parameters, features, known},
                                       questions.starts.col(i), i, options);
  });
  return posteriors;
}

}  // namespace twinmap
