#include "framework/inference/measured_simulator.hpp"

#include <algorithm>
#include <stdexcept>

#include "framework/base/text/source_location.hpp"
#include "framework/data/features/experiment_features.hpp"
#include "framework/estimation/trained/refinement_starts.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/point_set.hpp"
#include "framework/inference/shown_start.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

ResponseNoise makeNoise(const NoiseSpec& spec, const ResponseLayout& layout, const StatedNoise& stated) {
  ResponseNoise noise(spec, layout);
  noise.replace(stated.rows);
  noise.share(stated.common);
  return noise;
}

NoiseHypothesis findUnknownNoise(const NoiseSpec& noise, const ResponseLayout& layout) {
  NoiseHypothesis hypothesis;
  for (const OutputNoiseSpec& spec : noise.stddev) {
    const auto& names = layout.output_names;
    const auto found = std::find(names.begin(), names.end(), spec.name.text);
    if (spec.stddev.unknown && found != names.end()) {
      hypothesis.outputs.push_back({static_cast<int>(found - names.begin()), std::nullopt});
    }
  }
  return hypothesis;
}

}  // namespace

MeasuredSimulator::MeasuredSimulator(const ExperimentSpec& experiment, const ResponseLayout& layout,
                                     Model model, const StatedNoise& stated)
    : MeasuredSimulator(experiment, layout,
                        model == Model::kTrusted
                            ? makeTrustedSimulator(experiment.model, layout.times, layout.modes)
                            : makeSimulator(experiment.model, layout.times, layout.modes),
                        stated) {}

MeasuredSimulator::MeasuredSimulator(const ExperimentSpec& experiment, const ResponseLayout& layout,
                                     std::unique_ptr<Simulator> simulator, const StatedNoise& stated)
    : model_(experiment.model),
      output_noise_(experiment.noise.stddev),
      noise_scale_(experiment.noise.scale),
      extractor_(makeExtractor(experiment, layout)),
      simulator_(std::move(simulator)),
      noise_(extractor_, makeNoise(experiment.noise, layout, stated), experiment.seed, stated.features),
      stated_noise_(findUnknownNoise(experiment.noise, layout)),
      wanted_(shouldRefine(experiment.refine, *simulator_, noise_)),
      own_(simulator_->clone()) {}

const RefinementModel& MeasuredSimulator::getModel() const {
  if (!shared_) {
    shared_.emplace(collectUnknown(model_), extractor_, noise_);
  }
  return *shared_;
}

void MeasuredSimulator::requireNoise() const {
  try {
    getModel();
  } catch (const std::invalid_argument& error) {
    throw ExperimentError(
        std::string(error.what()) +
        ": a measurement says nothing about parameters unless its noise is known; give every output that "
        "features read a 'noise.stddev'");
  }
}

bool MeasuredSimulator::samplesFast() const {
  return shouldRefine(RefineMode::kAutomatic, *simulator_, noise_);
}

NoiseHypothesis MeasuredSimulator::describeNoise(const std::vector<ClippedSample>& clipped) const {
  NoiseHypothesis noise = stated_noise_;
  for (const ClippedSample& sample : clipped) {
    noise.censored.push_back({sample.row, sample.side});
  }
  std::sort(noise.censored.begin(), noise.censored.end(),
            [](const CensoredFeature& a, const CensoredFeature& b) { return a.feature < b.feature; });
  return noise;
}

void MeasuredSimulator::nameNoise(std::vector<NoiseReport>& reports) const {
  const ResponseLayout& layout = simulator_->getLayout();
  for (NoiseReport& report : reports) {
    const auto output = static_cast<std::size_t>(report.found.output);
    report.output = layout.output_names[output];
    report.unit = layout.output_units[output];
    const auto stated =
        std::find_if(output_noise_.begin(), output_noise_.end(),
                     [&](const OutputNoiseSpec& spec) { return spec.name.text == report.output; });
    const double stddev = noise_scale_ * stated->stddev;
    report.stated = stated->stddev.unknown ? 0.0 : stddev;
    report.stddev = report.found.factor * stddev;
  }
}

MeasuredTrial MeasuredSimulator::makeTrial(const VectorXd& features, const VectorXd& known) const {
  const std::vector<ParameterSpec>& unknown = getUnknown();
  VectorXd held(static_cast<Index>(unknown.size()) + known.size());
  held << calcBoxCenter(unknown), known;
  MeasuredTrial trial{own_.get(), &getModel(), features, held, listIndices(unknown.size())};
  trial.noise = stated_noise_;
  trial.shown = readShownStart(model_, extractor_.getInfos(), features);
  if (features.hasNaN()) {
    const VectorXd fitted = getModel().convert(features);
    std::vector<Index> available;
    for (Index i = 0; i < fitted.size(); ++i) {
      if (std::isfinite(fitted[i])) {
        available.push_back(i);
      }
    }
    trial.own_model =
        std::make_shared<const RefinementModel>(unknown, extractor_, noise_, std::move(available));
    trial.model = trial.own_model.get();
  }
  return trial;
}

std::string MeasuredSimulator::findFailure(const VectorXd& known) const {
  constexpr Index kPoints = 4;  // the centre of the bounds first
  const std::vector<ParameterSpec>& unknown = getUnknown();
  PointSetSpec sobol;
  sobol.method = DesignMethod::kSobol;
  sobol.samples = kPoints - 1;
  const auto u = static_cast<Index>(unknown.size());
  MatrixXd points(u + known.size(), kPoints);
  const MatrixXd unit = sampleUnitCube(sobol, static_cast<int>(u), 1, RandomPurpose::kBasinStarts);
  const VectorXd center = calcBoxCenter(unknown), widths = calcWidths(unknown);
  points.topRows(u).col(0) = center;
  for (Index i = 1; i < kPoints; ++i) {
    points.col(i).head(u) = center.array() + widths.array() * (unit.col(i - 1).array() - 0.5);
  }
  points.bottomRows(known.size()).colwise() = known;
  MatrixXd responses(simulator_->getLayout().getRowCount(), kPoints);
  std::vector<SampleStatus> statuses(kPoints);
  own_->simulate(points.leftCols(1), responses.leftCols(1), statuses.data());
  if (!statuses.front().ok) {
    own_->simulate(points.rightCols(kPoints - 1), responses.rightCols(kPoints - 1), statuses.data() + 1);
  }
  const bool fails =
      std::none_of(statuses.begin(), statuses.end(), [](const SampleStatus& one) { return one.ok; });
  return fails ? statuses.front().reason : "";
}

}  // namespace twinmap
