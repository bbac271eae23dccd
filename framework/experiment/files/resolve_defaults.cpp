#include "framework/experiment/files/resolve_defaults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "framework/experiment/model/curve.hpp"
#include "framework/experiment/network_size.hpp"
#include "framework/experiment/noise_correlation.hpp"
#include "framework/experiment/points/prior_marginal.hpp"

namespace twinmap {
namespace {

void resolveBounds(std::vector<ParameterSpec>& parameters) {
  for (ParameterSpec& parameter : parameters) {
    if (!parameter.bounds.isGiven()) {
      parameter.bounds = calcPriorRange(*parameter.prior);
      parameter.bounds.where = parameter.name.where;
    }
  }
}

/// A parameter for each knot of a curve that gives their number.
void resolveCurves(ModelSpec& model) {
  for (CurveSpec& curve : model.system.curves) {
    for (const Expression& value : listKnotParameters(curve)) {
      ParameterSpec knot;
      knot.name = {value.text, value.where};
      knot.bounds = *curve.bounds;
      knot.unit = curve.unit;
      knot.description = fmt::format("value of {} at its knot", curve.name.text);
      model.parameters.push_back(knot);
      curve.values.push_back(value);
    }
    curve.knots.reset();
    curve.bounds.reset();
  }
}

/// Texts of products that add up to entry i, j of S S', S the upper triangle of spreads and skews.
std::vector<std::string> listSecondMoment(const InertiaSpec& inertia, std::size_t i, std::size_t j) {
  const Expression zero;
  const Expression3 &spread = *inertia.spread, skew = inertia.skew.value_or(Expression3{});
  const std::array<Expression3, 3> s{
      {{spread[0], skew[0], skew[1]}, {zero, spread[1], skew[2]}, {zero, zero, spread[2]}}};
  std::vector<std::string> terms;
  for (std::size_t k = 0; k < s.size(); ++k) {
    if (s[i][k].text != zero.text && s[j][k].text != zero.text) {
      terms.push_back(fmt::format("({})*({})", s[i][k].text, s[j][k].text));
    }
  }
  return terms;
}

/// The tensor of a body whose mass is spread so: I = tr(C) 1 - C with C = m S S'.
void resolveInertia(BodySpec& body) {
  const InertiaSpec spread = body.inertia;
  if (!spread.spread) {
    return;
  }
  const auto write = [&](const char* sign, const std::vector<std::string>& terms) {
    return Expression{terms.empty()
                          ? Expression{}.text
                          : fmt::format("{}({})*({})", sign, body.mass.text, fmt::join(terms, " + ")),
                      (*spread.spread)[0].where};
  };
  body.inertia = InertiaSpec{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t first = i == 0 ? 1 : 0, second = i == 2 ? 1 : 2;  // the other two, in order
    std::vector<std::string> terms = listSecondMoment(spread, first, first);
    for (std::string& term : listSecondMoment(spread, second, second)) {
      terms.push_back(std::move(term));
    }
    body.inertia.moments[i] = write("", terms);
  }
  body.inertia.products = {write("-", listSecondMoment(spread, 0, 1)),
                           write("-", listSecondMoment(spread, 0, 2)),
                           write("-", listSecondMoment(spread, 1, 2))};
}

void resolveReport(const std::vector<ParameterSpec>& parameters, ReportSpec& report) {
  if (report.over.empty() && parameters.size() >= 2) {
    report.over = {parameters[parameters.size() - 2].name, parameters.back().name};
  }
}

void resolveTransform(ExperimentSpec& experiment) {
  if (experiment.transform.empty()) {
    const bool correlated = !experiment.noise.correlation.empty();
    const SourceLocation where{experiment.name.where.file, 0, 0, "transform"};
    experiment.transform = {
        {WhitenSpec{correlated ? WhitenBy::kCovariance : WhitenBy::kStddev}, where},
        {PrincipalComponentsSpec{}, where},
    };
  }
}

void resolveRounding(const std::vector<OutputSpec>& outputs, NoiseSpec& noise) {
  noise.rounded.clear();
  for (const OutputSpec& output : outputs) {
    if (output.sensor && output.sensor->quantum) {
      noise.rounded.push_back({output.name.text, *output.sensor->quantum});
    }
  }
}

/// 8 standard deviations of the noise: independent noise alone exceeds that between two of 1000 samples in
/// less than 1 % of windows (1000^2 pairs, each with the probability Q(8 / sqrt 2) = 7.7e-9).
void resolveProminence(const NoiseSpec& noise, ExtremaFeatureSpec& extrema) {
  constexpr double kNoiseStddevs = 8.0;
  for (const OutputNoiseSpec& output : noise.stddev) {
    if (!extrema.prominence && output.name.text == extrema.output.text) {
      extrema.prominence = kNoiseStddevs * noise.scale * output.stddev;
    }
  }
}

/// A surrogate's cross-validation tells what more samples are worth; processes from features to parameters
/// take the paper's number, and so does a network, which a surrogate can teach. 100 samples are the fewest
/// that five folds of 8 unknowns can be learnt from; a longer set must begin with the shorter one. Without a
/// map nothing is trained, whatever number the file gives.
void resolveTrainingSamples(const InverseMapSpec& map, PointSetSpec& train) {
  constexpr int kSmallest = 100, kMax = 800, kOfProcesses = 250;
  constexpr double kSeconds = 10.0;
  if (map.isNone()) {
    train.samples = SampleCount::makeAutomatic(0);
    train.time.reset();
    return;
  }
  if (!train.samples.automatic) {
    return;
  }
  if (map.findGp() != nullptr || map.findNetwork() != nullptr) {
    train.samples = kOfProcesses;
    train.time.reset();
    return;
  }
  train.samples.number = kMax;
  train.time = train.time.value_or(kSeconds);
  if (train.method == DesignMethod::kLatinHypercube) {
    train.method = DesignMethod::kNestedLatinHypercube;
  }
  if (train.method == DesignMethod::kNestedLatinHypercube) {
    train.smallest = train.smallest.value_or(kSmallest);
  }
}

/// The size of a network that learns from simulations alone. That of a surrogate's student is left open: its
/// training tells whether the small one suffices.
void resolveNetwork(int simulations, InverseMapSpec& map) {
  auto* network = std::get_if<NetworkMapSpec>(&map.kind);
  if (network == nullptr || (network->mayLearnFromSurrogate(simulations) && !hasSize(*network))) {
    return;
  }
  const NetworkSize size =
      network->mayLearnFromSurrogate(simulations) ? NetworkSize::kSmall : chooseSize(simulations);
  *network = completeSize(std::move(*network), size);
}

/// 4 draws; fewer where the training set would have more than 3000 columns.
void resolveReplicates(int samples, NoiseSpec& noise) {
  constexpr int kMaxReplicates = 4, kMaxColumns = 3000;
  if (!noise.replicates && samples > 0) {
    noise.replicates = std::clamp(kMaxColumns / samples, 1, kMaxReplicates);
  }
}

}  // namespace

void resolveDefaults(ExperimentSpec& experiment) {
  for (auto* parameters :
       {&experiment.model.parameters, &experiment.model.nuisance, &experiment.model.inputs}) {
    resolveBounds(*parameters);
  }
  resolveReport(experiment.model.parameters, experiment.report);  // the file's own, if there are two
  resolveCurves(experiment.model);
  for (BodySpec& body : experiment.model.system.bodies) {
    resolveInertia(body);
  }
  resolveReport(experiment.model.parameters, experiment.report);
  resolveTransform(experiment);
  resolveNoiseCorrelation(experiment);
  resolveRounding(experiment.model.outputs, experiment.noise);
  for (FeatureSpec& feature : experiment.features) {
    if (auto* extrema = std::get_if<ExtremaFeatureSpec>(&feature)) {
      resolveProminence(experiment.noise, *extrema);
    }
  }
  resolveTrainingSamples(experiment.inverse_map, experiment.design.train);
  if (!experiment.design.train.samples.automatic) {
    resolveReplicates(experiment.design.train.samples, experiment.noise);
  }
  resolveNetwork(experiment.design.train.samples, experiment.inverse_map);
  for (InverseMapSpec& map : experiment.evaluation.maps) {
    resolveNetwork(experiment.design.train.samples, map);
  }
}

ExperimentSpec takeTrainingSamples(ExperimentSpec experiment, int samples) {
  experiment.design.train.samples = samples;
  experiment.design.train.time.reset();
  resolveReplicates(samples, experiment.noise);
  return experiment;
}

}  // namespace twinmap
