#include "framework/estimation/estimate.hpp"

#include "framework/c_api/guard.hpp"
#include "framework/c_api/handles.hpp"
#include "framework/inference/text/inference_text.hpp"

namespace {

using Eigen::VectorXd;
using twinmap::c_api::guard;
using twinmap::c_api::kNaN;
using twinmap::c_api::require;
using twinmap::c_api::requireCount;
using twinmap::c_api::WrongArgument;

const twinmap_inferrer::Inferred& getInferred(const twinmap_inferrer* inferrer) {
  const twinmap_inferrer& self = require(inferrer, "inferrer");
  if (!self.inferred) {
    throw WrongArgument(
        "there is no estimate: nothing was inferred, or the last measurement could not be used");
  }
  return *self.inferred;
}

const twinmap::Estimate& getEstimate(const twinmap_inferrer* inferrer) {
  const twinmap::Estimate& estimate = getInferred(inferrer).estimate;
  if (!estimate.isGiven()) {
    throw WrongArgument("there is no estimate: the measurement's status is " + estimate.statuses.back());
  }
  return estimate;
}

const twinmap::Estimate* findEstimate(const twinmap_inferrer* inferrer) {
  return inferrer != nullptr && inferrer->inferred ? &inferrer->inferred->estimate : nullptr;
}

void copy(const Eigen::Ref<const VectorXd>& from, double* values, std::size_t count, const char* what) {
  requireCount(count, static_cast<std::size_t>(from.size()), what);
  Eigen::Map<VectorXd>(&require(values, what), from.size()) = from;
}

const twinmap::Trust* findTrust(const twinmap_inferrer* inferrer) {
  const bool known = inferrer != nullptr && inferrer->inferred && inferrer->inferred->measurement.trust;
  return known ? &*inferrer->inferred->measurement.trust : nullptr;
}

/// Of an experiment alone; null where there is none, or nothing was simulated.
const twinmap::SimulatorFit* findFit(const twinmap_inferrer* inferrer) {
  if (inferrer == nullptr || !inferrer->inferred) {
    return nullptr;
  }
  const std::optional<twinmap::PosteriorEstimate>& posterior = inferrer->inferred->measurement.posterior;
  return posterior && posterior->fit && posterior->fit->isSimulated() ? &*posterior->fit : nullptr;
}

double getNumber(const twinmap::SimulatorFit& fit, twinmap_number number) {
  switch (number) {
    case TWINMAP_P_VALUE:
      return fit.test.calcPValue();
    case TWINMAP_CHI_SQUARE:
      return fit.chi_square;
    case TWINMAP_RESIDUALS:
      return static_cast<double>(fit.residual.size());
    case TWINMAP_CHI_SQUARE_P_VALUE:
      return fit.test.chi_square_p;
    case TWINMAP_ANOMALY_P_VALUE:
    case TWINMAP_DISTANCE:
      break;
  }
  return kNaN;
}

}  // namespace

twinmap_result twinmap_get_mean(const twinmap_inferrer* inferrer, double* values, size_t count) {
  return guard([&] { copy(getEstimate(inferrer).mean, values, count, "values"); });
}

twinmap_result twinmap_get_stddev(const twinmap_inferrer* inferrer, double* values, size_t count) {
  return guard([&] { copy(getEstimate(inferrer).stddev, values, count, "values"); });
}

twinmap_result twinmap_get_interval(const twinmap_inferrer* inferrer, double* lower, double* upper,
                                    size_t count) {
  return guard([&] {
    const twinmap::Bounds95 bounds = getEstimate(inferrer).calcBounds95();
    copy(bounds.lower, lower, count, "lower");
    copy(bounds.upper, upper, count, "upper");
  });
}

twinmap_result twinmap_get_covariance(const twinmap_inferrer* inferrer, double* values, size_t count) {
  return guard([&] {
    const Eigen::MatrixXd covariance = getEstimate(inferrer).calcCovariance();
    copy(covariance.reshaped(), values, count, "values");
  });
}

size_t twinmap_count_components(const twinmap_inferrer* inferrer) {
  const twinmap::Estimate* estimate = findEstimate(inferrer);
  if (estimate == nullptr || !estimate->isGiven()) {
    return 0;
  }
  return estimate->mixture.isGiven() ? static_cast<std::size_t>(estimate->mixture.countComponents()) : 1;
}

twinmap_result twinmap_get_component(const twinmap_inferrer* inferrer, size_t index, double* weight,
                                     double* mean, double* stddev, size_t count) {
  return guard([&] {
    const twinmap::Estimate& estimate = getEstimate(inferrer);
    const std::size_t components = twinmap_count_components(inferrer);
    if (index >= components) {
      throw WrongArgument("component " + std::to_string(index) + ": there are " + std::to_string(components));
    }
    const auto k = static_cast<Eigen::Index>(index);
    const twinmap::Mixture& mixture = estimate.mixture;
    require(weight, "weight") = mixture.isGiven() ? mixture.weights[k] : 1.0;
    copy(mixture.isGiven() ? VectorXd(mixture.means.col(k)) : estimate.mean, mean, count, "mean");
    copy(mixture.isGiven() ? VectorXd(mixture.stddevs.col(k)) : estimate.stddev, stddev, count, "stddev");
  });
}

size_t twinmap_count_draws(const twinmap_inferrer* inferrer) {
  const twinmap::Estimate* estimate = findEstimate(inferrer);
  return estimate != nullptr ? static_cast<std::size_t>(estimate->draws.weights.size()) : 0;
}

twinmap_result twinmap_get_draws(const twinmap_inferrer* inferrer, double* values, double* weights,
                                 size_t draws) {
  return guard([&] {
    const twinmap::Estimate& estimate = getEstimate(inferrer);
    if (!estimate.draws.isGiven()) {
      throw WrongArgument("the estimate has no draws, as it is not a posterior");
    }
    copy(estimate.draws.weights, weights, draws, "weights");
    const Eigen::MatrixXd points = estimate.draws.points.topRows(estimate.mean.size());
    Eigen::Map<Eigen::MatrixXd>(&require(values, "values"), points.rows(), points.cols()) = points;
  });
}

int twinmap_is_refined(const twinmap_inferrer* inferrer) {
  const twinmap::Estimate* estimate = findEstimate(inferrer);
  return estimate != nullptr && estimate->isRefined() ? 1 : 0;
}

const char* twinmap_get_method(const twinmap_inferrer* inferrer) {
  const twinmap::Estimate* estimate = findEstimate(inferrer);
  return estimate != nullptr ? estimate->getMethod() : nullptr;
}

size_t twinmap_count_statuses(const twinmap_inferrer* inferrer) {
  const twinmap::Estimate* estimate = findEstimate(inferrer);
  return estimate != nullptr ? estimate->statuses.size() : 0;
}

const char* twinmap_get_status(const twinmap_inferrer* inferrer, size_t index) {
  return index < twinmap_count_statuses(inferrer) ? findEstimate(inferrer)->statuses[index].c_str() : nullptr;
}

double twinmap_get_number(const twinmap_inferrer* inferrer, twinmap_number number) {
  const twinmap::Trust* trust = findTrust(inferrer);
  if (trust == nullptr) {
    const twinmap::SimulatorFit* fit = findFit(inferrer);
    return fit != nullptr ? getNumber(*fit, number) : kNaN;
  }
  switch (number) {
    case TWINMAP_P_VALUE:
      return trust->p_value;
    case TWINMAP_CHI_SQUARE:
      return trust->chi_square;
    case TWINMAP_RESIDUALS:
      return static_cast<double>(trust->residuals);
    case TWINMAP_CHI_SQUARE_P_VALUE:
      return trust->chi_square_p_value;
    case TWINMAP_ANOMALY_P_VALUE:
      return trust->anomaly_p_value;
    case TWINMAP_DISTANCE:
      return trust->distance;
  }
  return kNaN;
}

const char* twinmap_get_json(twinmap_inferrer* inferrer) {
  const twinmap_result result = guard([&] {
    const twinmap::InferredMeasurement& measurement = getInferred(inferrer).measurement;
    inferrer->json =
        twinmap::makeInferenceJson(measurement, inferrer->source.getExperiment().model.parameters,
                                   inferrer->source.getReader().getExtractor().getInfos());
  });
  return result == TWINMAP_OK ? inferrer->json.c_str() : nullptr;
}
