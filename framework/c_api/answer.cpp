#include "framework/c_api/guard.hpp"
#include "framework/c_api/handles.hpp"
#include "framework/estimation/predictions.hpp"
#include "framework/inference/inference_text.hpp"

namespace {

using Eigen::VectorXd;
using twinmap::c_api::guard;
using twinmap::c_api::kNaN;
using twinmap::c_api::require;
using twinmap::c_api::requireCount;
using twinmap::c_api::WrongArgument;

const twinmap_inferrer::Answered& getAnswered(const twinmap_inferrer* inferrer) {
  const twinmap_inferrer& self = require(inferrer, "inferrer");
  if (!self.answered) {
    throw WrongArgument(
        "there is no answer: nothing was inferred, or the last measurement could not be used");
  }
  return *self.answered;
}

void copy(const Eigen::Ref<const VectorXd>& from, double* values, std::size_t count, const char* what) {
  requireCount(count, static_cast<std::size_t>(from.size()), what);
  Eigen::Map<VectorXd>(&require(values, what), from.size()) = from;
}

const twinmap::Trust* findTrust(const twinmap_inferrer* inferrer) {
  const bool known = inferrer != nullptr && inferrer->answered && inferrer->answered->measurement.trust;
  return known ? &*inferrer->answered->measurement.trust : nullptr;
}

}  // namespace

twinmap_result twinmap_get_mean(const twinmap_inferrer* inferrer, double* values, size_t count) {
  return guard([&] { copy(getAnswered(inferrer).answer.mean, values, count, "values"); });
}

twinmap_result twinmap_get_stddev(const twinmap_inferrer* inferrer, double* values, size_t count) {
  return guard([&] { copy(getAnswered(inferrer).answer.stddev, values, count, "values"); });
}

twinmap_result twinmap_get_interval(const twinmap_inferrer* inferrer, double* lower, double* upper,
                                    size_t count) {
  return guard([&] {
    const twinmap::Answer& answer = getAnswered(inferrer).answer;
    copy(answer.lower95, lower, count, "lower");
    copy(answer.upper95, upper, count, "upper");
  });
}

twinmap_result twinmap_get_covariance(const twinmap_inferrer* inferrer, double* values, size_t count) {
  return guard([&] {
    const twinmap::InferredMeasurement& measurement = getAnswered(inferrer).measurement;
    const Eigen::MatrixXd covariance = twinmap::calcAnswerCovariance(inferrer->inferrer, measurement);
    copy(covariance.reshaped(), values, count, "values");
  });
}

int twinmap_is_refined(const twinmap_inferrer* inferrer) {
  return inferrer != nullptr && inferrer->answered && inferrer->answered->answer.isRefined() ? 1 : 0;
}

const char* twinmap_get_method(const twinmap_inferrer* inferrer) {
  return inferrer != nullptr && inferrer->answered ? toString(inferrer->answered->answer.method) : nullptr;
}

size_t twinmap_count_statuses(const twinmap_inferrer* inferrer) {
  return inferrer != nullptr && inferrer->answered ? inferrer->answered->statuses.size() : 0;
}

const char* twinmap_get_status(const twinmap_inferrer* inferrer, size_t index) {
  return index < twinmap_count_statuses(inferrer) ? inferrer->answered->statuses[index].c_str() : nullptr;
}

double twinmap_get_number(const twinmap_inferrer* inferrer, twinmap_number number) {
  const twinmap::Trust* trust = findTrust(inferrer);
  if (trust == nullptr) {
    return kNaN;
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
    const twinmap::InferredMeasurement& measurement = getAnswered(inferrer).measurement;
    inferrer->json =
        twinmap::makeInferenceJson(measurement, inferrer->inferrer.getExperiment().model.parameters,
                                   inferrer->inferrer.getExtractor().getInfos());
  });
  return result == TWINMAP_OK ? inferrer->json.c_str() : nullptr;
}
