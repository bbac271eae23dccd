#include <fmt/core.h>

#include <cmath>

#include "framework/base/text/escape.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/inference/stated_values.hpp"
#include "framework/inference/text/inference_text.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// "source,start"; several recordings together have no start.
std::string nameMeasurement(const InferredMeasurement& inferred) {
  return escapeCsv(inferred.source) + "," + (std::isnan(inferred.start) ? "" : toText(inferred.start));
}

/// "mean,sd,lower,upper"; empty cells where nothing is known.
std::string makeMoments(const Estimate& estimate, const Bounds95& bounds, Index parameter) {
  return isStated(estimate, parameter)
             ? fmt::format("{},{},{},{}", toText(estimate.mean[parameter]),
                           toText(estimate.stddev[parameter]), toText(bounds.lower[parameter]),
                           toText(bounds.upper[parameter]))
             : ",,,";
}

/// "0.52: 0.05 +- 0.001; 0.48: -0.05 +- 0.001", weight, mean and sd of each; "" of one.
std::string makeComponents(const Mixture& mixture, Index parameter) {
  std::string text;
  for (Index c = 0; c < mixture.countComponents(); ++c) {
    text += fmt::format("{}{}: {} +- {}", c == 0 ? "" : "; ", toText(mixture.weights[c]),
                        toText(mixture.means(parameter, c)), toText(mixture.stddevs(parameter, c)));
  }
  return text;
}

/// Empty but for the diagnostics where it is not reliable.
std::string makePosteriorCells(const PosteriorEstimate& posterior, Index parameter) {
  const bool reliable = posterior.isReliable();
  const MatrixXd quantiles = reliable ? calcQuantiles(posterior.estimate) : MatrixXd();
  std::string text = reliable ? fmt::format(",{},{}", toText(posterior.estimate.mean[parameter]),
                                            toText(posterior.estimate.stddev[parameter]))
                              : ",,";
  for (Index k = 0; k < static_cast<Index>(kQuantileProbabilities.size()); ++k) {
    text += reliable ? "," + toText(quantiles(parameter, k)) : ",";
  }
  return text + "," + toText(posterior.effective_sample_size) + "," + toText(posterior.pareto_shape);
}

std::string makePValue(const InferredMeasurement& inferred) {
  if (inferred.trust) {
    return toText(inferred.trust->p_value);
  }
  const bool tested = inferred.posterior && inferred.posterior->fit && inferred.posterior->fit->isSimulated();
  return tested ? toText(inferred.posterior->fit->test.calcPValue()) : "";
}

std::string makeRefinedCells(const InferredMeasurement& inferred, const Estimate& estimate, Index parameter) {
  const Estimate& by_estimator = inferred.by_estimator;
  const bool accepted = inferred.refined->isAccepted();
  const Estimate refined = accepted ? makeEstimate(*inferred.refined, estimate.mean.size()) : Estimate{};
  return (accepted ? fmt::format(",{},{}", toText(refined.mean[parameter]), toText(refined.stddev[parameter]))
                   : ",,") +
         fmt::format(",{},{}", toText(by_estimator.mean[parameter]), toText(by_estimator.stddev[parameter]));
}

/// ",mean,sd" of a value by one of the estimates beside; empty cells where there is none.
std::string makeDerivedMoments(const std::vector<DerivedValue>& values, std::size_t value) {
  return value < values.size()
             ? fmt::format(",{},{}", toText(values[value].mean), toText(values[value].stddev))
             : ",,";
}

/// Rows like those of parameters: what is derived, then what is identified. judged: the cells of the
/// judgement.
std::string makeDerivedRows(const InferredMeasurement& inferred, const StatedValues& stated,
                            const std::string& judged, bool posterior) {
  const DerivedQuantities* quantities = inferred.quantities.get();
  std::vector<DerivedValue> found = stated.derived;
  found.insert(found.end(), stated.identified.begin(), stated.identified.end());
  std::string text;
  for (std::size_t k = 0; k < found.size(); ++k) {
    const DerivedValue& value = found[k];
    text +=
        fmt::format("{},{},{},{},{}", nameMeasurement(inferred), escapeCsv(value.name), escapeCsv(value.unit),
                    value.isStated() ? fmt::format("{},{},{},{}", toText(value.mean), toText(value.stddev),
                                                   toText(value.lower95), toText(value.upper95))
                                     : ",,,",
                    judged);
    if (inferred.refined) {
      const bool accepted = inferred.refined->isAccepted();
      const Estimate refined =
          accepted ? makeEstimate(*inferred.refined, stated.estimate.mean.size()) : Estimate{};
      text += makeDerivedMoments(deriveFrom(quantities, refined), k) +
              makeDerivedMoments(deriveFrom(quantities, inferred.by_estimator), k);
    }
    if (posterior) {
      const std::vector<DerivedValue> sampled = deriveFrom(quantities, inferred.posterior->estimate);
      text += makeDerivedMoments(sampled, k) +
              (k < sampled.size()
                   ? fmt::format(",{},,,,{}", toText(sampled[k].lower95), toText(sampled[k].upper95))
                   : ",,,,,") +
              fmt::format(",{},{}", toText(inferred.posterior->effective_sample_size),
                          toText(inferred.posterior->pareto_shape));
    }
    text += ",\n";
  }
  return text;
}

std::string listColumns(const std::vector<ParameterSpec>& unknown) {
  std::string text;
  for (const ParameterSpec& parameter : unknown) {
    text += "," + escapeCsv(parameter.name.text);
  }
  return text + "\n";
}

}  // namespace

std::string makeInferenceCsvHeader(bool refined, bool posterior) {
  return std::string("source,start,parameter,unit,mean,sd,lower,upper,status,p_value,method") +
         (refined ? ",refined_mean,refined_sd,map_mean,map_sd" : "") +
         (posterior ? ",posterior_mean,posterior_sd,posterior_q2.5,posterior_q16,posterior_q50,posterior_q84,"
                      "posterior_q97.5,effective_sample_size,pareto_shape"
                    : "") +
         ",components\n";
}

std::string makeInferenceCsvRows(const InferredMeasurement& inferred,
                                 const std::vector<ParameterSpec>& parameters, bool posterior) {
  return makeAnswerCsvRows(inferred, selectEstimate(inferred), makePValue(inferred), parameters, posterior);
}

std::string makeAnswerCsvRows(const InferredMeasurement& inferred, const Estimate& estimate,
                              const std::string& p_value, const std::vector<ParameterSpec>& parameters,
                              bool posterior) {
  const std::string judged =
      fmt::format("{},{},{}", joinStatuses(estimate.statuses, " "), p_value, estimate.getMethod());
  const StatedValues stated = stateValues(inferred, estimate, parameters);
  const Bounds95 bounds = stated.estimate.calcBounds95();
  std::string text;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto i = static_cast<Index>(p);
    text += fmt::format("{},{},{},{},{}", nameMeasurement(inferred), escapeCsv(parameters[p].name.text),
                        escapeCsv(parameters[p].unit), makeMoments(stated.estimate, bounds, i), judged);
    if (inferred.refined) {
      text += makeRefinedCells(inferred, estimate, i);
    }
    if (posterior) {
      text += makePosteriorCells(*inferred.posterior, i);
    }
    text += "," + makeComponents(estimate.mixture, i) + "\n";
  }
  return text + makeDerivedRows(inferred, stated, judged, posterior);
}

std::string makeDrawsCsvHeader(const std::vector<ParameterSpec>& unknown) {
  return "source,start,draw,weight" + listColumns(unknown);
}

std::string makeDrawsCsvRows(const InferredMeasurement& inferred) {
  if (!inferred.posterior) {
    return "";
  }
  const BoundedDraws& draws = inferred.posterior->estimate.draws;
  const std::string measurement = nameMeasurement(inferred);
  std::string text;
  for (Index i = 0; i < draws.weights.size(); ++i) {
    text += fmt::format("{},{},{}", measurement, i, toText(draws.weights[i]));
    for (const double value : draws.points.col(i)) {
      text += "," + toText(value);
    }
    text += "\n";
  }
  return text;
}

std::string makeProfileCsvHeader(const std::vector<ParameterSpec>& unknown) {
  return "source,start,parameter,value,log_likelihood_ratio" + listColumns(unknown);
}

std::string makeProfileCsvRows(const InferredMeasurement& inferred,
                               const std::vector<ParameterSpec>& unknown) {
  if (!inferred.posterior) {
    return "";
  }
  const std::string measurement = nameMeasurement(inferred);
  std::string text;
  for (const Profile& profile : inferred.posterior->profiles) {
    const std::string& name = unknown[static_cast<std::size_t>(profile.parameter)].name.text;
    for (Index i = 0; i < profile.log_ratios.size(); ++i) {
      text += fmt::format("{},{},{},{}", measurement, escapeCsv(name),
                          toText(profile.points(profile.parameter, i)), toText(profile.log_ratios[i]));
      for (const double value : profile.points.col(i)) {
        text += "," + toText(value);
      }
      text += "\n";
    }
  }
  return text;
}

}  // namespace twinmap
