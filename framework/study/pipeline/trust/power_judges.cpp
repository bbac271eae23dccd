#include "framework/study/pipeline/trust/power_judges.hpp"

#include <algorithm>

#include "framework/estimation/refined/acceptance.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// What parameters take up of whitened residuals: J (J'J + prior)^-1 J', J per half-width.
class Absorption {
 public:
  Absorption(MatrixXd jacobian, const BoxPrior& prior)
      : jacobian_(std::move(jacobian)),
        hessian_(jacobian_.transpose() * jacobian_ + prior.calcInformation()) {}

  VectorXd remove(const VectorXd& residual) const {
    return residual - jacobian_ * linalg::solvePositiveDefinite(hessian_, jacobian_.transpose() * residual);
  }

  /// Residuals less what is determined of the parameters.
  double calcDegrees() const {
    const MatrixXd information = jacobian_.transpose() * jacobian_;
    const double determined =
        linalg::solveCholesky(linalg::calcCholesky(hessian_).lower, information).trace();
    return std::max(1.0, static_cast<double>(jacobian_.rows()) - determined);
  }

 private:
  MatrixXd jacobian_, hessian_;
};

/// By what the surrogate leaves, linearised where it explains the features without noise: its error there is
/// part of what is judged.
class SurrogateJudge final : public PowerJudge {
 public:
  SurrogateJudge(const Estimator& map, const TrustModel& trust, const Stencil& at)
      : trust_(trust),
        explanation_(explain(map, trust, at)),
        absorption_(explanation_.jacobian, trust.prior),
        centered_(at.features - trust.forward->center) {}

  double calcPValue(const VectorXd& moved) const override {
    const VectorXd scores = trust_.forward->projection * moved;
    const VectorXd innovation = explanation_.innovation + absorption_.remove(explanation_.whiten(scores));
    VectorXd residual;
    trust_.space.calcResidual(centered_ + moved, innovation, residual);
    Trust trust;
    compareWithSimulated(trust_, residual, trust);
    return trust.p_value;
  }

 private:
  static ScoreExplanation explain(const Estimator& map, const TrustModel& trust, const Stencil& at) {
    const std::unique_ptr<Estimator::Workspace> inferring = map.makeWorkspace();
    TrustWorkspace judging(trust);
    const Estimate& estimate = map.inferMean(at.features, at.known, *inferring);
    judge(trust, at.features, at.known, estimate, inferring->findExplanation(), judging);
    return *judging.explanation;
  }

  const TrustModel& trust_;
  const ScoreExplanation explanation_;
  const Absorption absorption_;
  const VectorXd centered_;
};

/// By what the simulator leaves; by the surrogate where that does not decide.
class RefinedJudge final : public PowerJudge {
 public:
  RefinedJudge(const Estimator& map, const TrustModel& trust, const NoiseWhitener& noise, const Stencil& at)
      : trust_(trust),
        noise_(noise),
        absorption_(noise.apply(at.sensitivities), trust.prior),
        degrees_(absorption_.calcDegrees()),
        limit_(calcChiSquareLimit(degrees_)),
        surrogate_(map, trust, at) {}

  double calcPValue(const VectorXd& moved) const override {
    const VectorXd residual = absorption_.remove(noise_.apply(moved));
    const double chi_square = residual.squaredNorm();
    const SimulatorResidual found{residual, chi_square / degrees_, degrees_, chi_square < limit_, {}, {}};
    Trust by_surrogate;
    if (!found.explained) {
      by_surrogate.p_value = surrogate_.calcPValue(moved);
    }
    return judgeAnew(trust_, by_surrogate, found).p_value;
  }

 private:
  const TrustModel& trust_;
  const NoiseWhitener& noise_;
  const Absorption absorption_;
  const double degrees_, limit_;
  const SurrogateJudge surrogate_;
};

}  // namespace

std::unique_ptr<PowerJudge> makePowerJudge(const Estimator& map, const TrustModel& trust,
                                           const NoiseWhitener& noise, const Stencil& at) {
  if (trust.refinement.tried > 0) {
    return std::make_unique<RefinedJudge>(map, trust, noise, at);
  }
  return std::make_unique<SurrogateJudge>(map, trust, at);
}

}  // namespace twinmap
