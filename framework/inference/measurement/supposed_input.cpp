#include "framework/inference/measurement/supposed_input.hpp"

#include <algorithm>

#include "framework/base/log/search_stage.hpp"
#include "framework/data/measurement/recording/recorded_times.hpp"
#include "framework/inference/measurement/excitation_noise.hpp"
#include "framework/inference/measurement/unknown_excitation.hpp"
#include "framework/simulation/team_simulator.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::unique_ptr<Simulator> makeTrustedTeam(const ExperimentSpec& experiment, const ResponseLayout& layout) {
  return shareAmongThreads(makeTrustedSimulator(experiment.model, layout.times, layout.modes));
}

/// Noise of unknown size is stated as that of another: rows are in units of that.
void divideByNoise(const ResponseLayout& layout, const std::vector<NoiseReport>& noise, MatrixXd& rows) {
  for (const NoiseReport& report : noise) {
    if (report.found.size_was_inferred) {
      rows.middleRows(layout.getRow(report.found.output, 0), layout.times.size()) /= report.found.factor;
    }
  }
}

/// The likeliest m of r = G n + noise of unit variance, n of unit variance as well.
VectorXd calcLikeliest(const MatrixXd& responses, const VectorXd& residual) {
  const Index r = responses.cols();
  return linalg::solvePositiveDefinite(MatrixXd::Identity(r, r) + responses.transpose() * responses,
                                       responses.transpose() * residual);
}

struct SupposedInput {
  ExperimentSpec experiment;  ///< with the likeliest excitation
  MatrixXd common;            ///< G, rows x r
  VectorXd offset;            ///< G m, rows
};

/// One measurement, from one supposition to the next.
class Supposing {
 public:
  Supposing(const MeasurementReader& reader, const AvailableFeatures& found, const VectorXd& known,
            const SimulatorPosteriorOptions& options)
      : reader_(reader),
        found_(found),
        known_(known),
        options_(options),
        input_{reader.getExperiment(), {}, {}} {
    input_.offset = VectorXd::Zero(reader.getLayout().getRowCount());
  }

  /// False where nothing can be simulated.
  bool improve() {
    const ResponseLayout& layout = reader_.getLayout();
    StatedNoise stated = found_.stated;
    stated.common = input_.common;
    const SimulatorSampler sampler(input_.experiment, layout, makeTrustedTeam(input_.experiment, layout),
                                   stated);
    const VectorXd features = found_.features + reader_.getExtractor().extract(input_.offset);
    const PosteriorEstimate fitted =
        sampler
            .sampleAsStated(features, known_, sampler.describeNoise(found_.clipped), given_,
                            given_.cols() > 0 ? searchNearby(options_) : options_)
            .estimate;
    if (!fitted.fit || !fitted.fit->isSimulated()) {
      return false;
    }
    given_ = fitted.fit->best;
    VectorXd point(given_.rows() + known_.size());
    point << given_, known_;
    const MatrixXd responses = calcUnknownResponses(input_.experiment.model, layout, point);
    input_.common = responses;
    divideByNoise(layout, fitted.fit->noise, input_.common);
    return responses.cols() > 0 && move(responses, *fitted.fit);
  }

  SupposedInput take() { return std::move(input_); }

 private:
  /// Moves the excitation to the likeliest beside these parameters.
  bool move(const MatrixXd& responses, const SimulatorFit& fit) {
    const ResponseLayout& layout = reader_.getLayout();
    const SimulatorSampler plain(input_.experiment, layout, makeTrustedTeam(input_.experiment, layout),
                                 found_.stated);
    std::optional<LinearizedMeasurement> local = plain.linearize(found_.features, known_, given_);
    if (!local || !local->whitener || local->residual.size() != static_cast<Index>(local->features.size())) {
      return false;
    }
    MatrixXd rows(layout.getRowCount(), responses.cols() + 1);
    rows << responses, VectorXd::Zero(rows.rows());
    MatrixXd own = local->whitener->apply(reader_.getExtractor().extract(rows)(local->features, Eigen::all));
    own.rightCols(1) = local->residual;
    divideByFoundNoise(*local, reader_.getExtractor(), fit, own);
    const MatrixXd effects = own.leftCols(responses.cols());
    if (moved_.size() == 0) {
      moved_ = VectorXd::Zero(responses.cols());
    }
    const VectorXd likeliest = calcLikeliest(effects, own.col(responses.cols()) + effects * moved_);
    input_.experiment.model = moveUnknown(reader_.getExperiment().model, likeliest);
    moved_ = likeliest;
    input_.offset = responses * likeliest;
    return true;
  }

  const MeasurementReader& reader_;
  const AvailableFeatures& found_;
  const VectorXd& known_;
  const SimulatorPosteriorOptions& options_;
  SupposedInput input_;
  MatrixXd given_;
  VectorXd moved_;
};

}  // namespace

std::optional<ExperimentSpec> supposeInput(const MeasurementReader& reader, AvailableFeatures& found,
                                           const VectorXd& known, SimulatorPosteriorOptions options) {
  if (!hasUnknownExcitation(reader.getExperiment().model) || !areSamples(reader.getExperiment().features)) {
    return std::nullopt;
  }
  const SearchStage stage = SearchStage::supposing("what the unknown of the excitation does");
  options.wants_draws = [](const SimulatorPosterior&) {
    return false;
  };  // the best fit is all that is asked for
  Supposing supposing(reader, found, known, options);
  for (int i = 0; i < kTimesCounted; ++i) {
    if (!supposing.improve()) {
      return std::nullopt;
    }
  }
  SupposedInput input = supposing.take();
  found.features += reader.getExtractor().extract(input.offset);
  found.response += input.offset;
  found.stated.common = std::move(input.common);
  return std::move(input.experiment);
}

std::unique_ptr<const SimulatorRefiner> makeOwnSimulator(const MeasurementReader& reader,
                                                         const SimulatorRefiner& usual,
                                                         AvailableFeatures& found, const VectorXd& known,
                                                         const SimulatorPosteriorOptions& options) {
  const std::optional<ExperimentSpec> supposed = supposeInput(reader, found, known, options);
  if (!supposed && !found.stated.isGiven()) {
    return nullptr;
  }
  const ResponseLayout& layout = reader.getLayout();
  return std::make_unique<const SimulatorRefiner>(
      supposed ? *supposed : reader.getExperiment(), layout,
      supposed ? makeTrustedTeam(*supposed, layout) : usual.getSimulator().clone(), found.stated);
}

}  // namespace twinmap
