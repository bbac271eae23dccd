#include "bench/framework/diagnosis/incomplete_machine.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/diagnosis/candidates/augment.hpp"
#include "framework/diagnosis/candidates/observed_motion.hpp"
#include "framework/diagnosis/diagnosis.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/tolerances/tolerances.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Added to a test's number, for what is drawn of the second of two terms.
constexpr int kSecondTerm = 500;

/// Whether a term of this size cannot be told from another, by the linear model.
bool isAlike(const ScoredCandidates& scored, std::size_t chosen, double size) {
  constexpr double kTold = 2.0 * kTiedEvidence;  // of chi-square
  const auto at = static_cast<Index>(chosen);
  const double whole = size * scored.test->calcLength(at);
  for (std::size_t k = 0; k < scored.candidates.size(); ++k) {
    const double likeness = scored.test->calcLikeness(at, static_cast<Index>(k));
    if (scored.candidates[k].term != scored.candidates[chosen].term && scored.scores[k].visible &&
        whole * whole * (1.0 - likeness * likeness) < kTold) {
      return true;
    }
  }
  return false;
}

/// A term at one of the scales that can be seen, if one can.
std::optional<std::size_t> choose(const ScoredCandidates& scored, const std::string& term) {
  std::vector<std::size_t> scales;
  for (std::size_t i = 0; i < scored.candidates.size(); ++i) {
    if (scored.candidates[i].term == term && scored.scores[i].visible) {
      scales.push_back(i);
    }
  }
  if (scales.empty()) {
    return std::nullopt;
  }
  return scales[scales.size() / 2];
}

}  // namespace

MachineMaker::MachineMaker(const std::string& file, std::uint64_t seed, const Ratios& ratios)
    : model_(followNoise(readExperimentWithSignals(loadExperimentTree(file)))),
      layout_(makeLayout(model_)),
      extractor_(makeExtractor(model_, layout_)),
      noise_(model_.noise, layout_),
      random_(seed, RandomPurpose::kTestDesign),
      seed_(seed),
      ratios_(ratios),
      shared_(static_cast<Index>(model_.model.parameters.size())) {}

std::vector<std::string> MachineMaker::listTerms() const {
  std::vector<std::string> terms{"none"};
  const ScoredCandidates scored = score(calcBoxCenter(collectUnknown(model_.model)));
  for (std::size_t i = 0; i < scored.candidates.size(); ++i) {
    const std::string& term = scored.candidates[i].term;
    if (scored.scores[i].visible && terms.back() != term) {
      terms.push_back(term);
    }
  }
  for (const ForcedCoordinate& coordinate : listForcedCoordinates(model_.model.system)) {
    terms.push_back("process." + coordinate.name);
  }
  return terms;
}

std::optional<IncompleteMachine> MachineMaker::make(const std::string& term, int test) const {
  IncompleteMachine machine{model_, drawPoint(test)};
  const std::size_t plus = term.find('+');
  const std::string second = plus == std::string::npos ? "none" : term.substr(plus + 1);
  if (!addMissing(term.substr(0, plus), test, test, machine) ||
      !addMissing(second, test, test + kSecondTerm, machine)) {
    return {};
  }
  return machine;
}

/// Adds a term whose size and scales are drawn for `drawn`; false where it does nothing.
bool MachineMaker::addMissing(const std::string& term, int test, int drawn,
                              IncompleteMachine& machine) const {
  if (term == "none") {
    return true;
  }
  const VectorXd point = drawPoint(test);
  ScoredCandidates scored;
  TermCandidate missing;
  std::optional<std::size_t> chosen;
  if (isProcess(term)) {
    missing = makeGust(term.substr(term.find('.') + 1), drawn);
  } else {
    scored = score(point);
    chosen = choose(scored, term);
    if (!chosen) {
      return false;
    }
    missing = scored.candidates[*chosen];
  }
  VectorXd added = VectorXd::Zero(1 + static_cast<Index>(missing.own_scales.size()));
  for (Index i = 1; i < added.size(); ++i) {
    const OwnScale& scale = missing.own_scales[static_cast<std::size_t>(i) - 1];
    const double factor = std::exp(drawUniform(drawn, 100 + i) - 0.5);
    added[i] = scale.value * std::clamp(factor, 1.0 / scale.reach, scale.reach);
  }
  added[0] = drawSize(addTerm(model_, missing, missing.size).experiment, point, added, drawn);
  if (added[0] == 0.0) {
    return false;
  }
  const auto parameters = static_cast<Index>(machine.experiment.model.parameters.size());
  machine.experiment =
      addTerm(machine.experiment, missing, std::max(missing.size, 2.0 * added[0])).experiment;
  machine.point = insertAdded(machine.point, parameters, added);
  machine.is_alike = machine.is_alike || (chosen && isAlike(scored, *chosen, added[0]));
  return true;
}

std::optional<VectorXd> MachineMaker::measure(const ExperimentSpec& machine, const VectorXd& point, int test,
                                              int repeat) const {
  const std::unique_ptr<Simulator> simulator =
      makeTrustedSimulator(machine.model, layout_.times, layout_.modes);
  MatrixXd response(layout_.getRowCount(), 1);
  SampleStatus status;
  simulator->simulate(point, response, &status);
  if (!status.ok) {
    return {};
  }
  const MatrixXd noisy =
      addNoise(response, noise_,
               {seed_ + 1000 * static_cast<std::uint64_t>(test) + static_cast<std::uint64_t>(repeat),
                RandomPurpose::kTestNoise});
  return extractor_.extract(noisy).col(0);
}

double MachineMaker::drawUniform(int test, Index channel) const {
  return random_.calcUniform(static_cast<std::uint64_t>(test), static_cast<std::uint64_t>(channel));
}

double MachineMaker::drawRatio(int test) const {
  return ratios_.least * std::pow(ratios_.most / ratios_.least, drawUniform(test, 100));
}

/// Of the model's parameters, away from the bounds.
VectorXd MachineMaker::drawPoint(int test) const {
  const std::vector<ParameterSpec> unknown = collectUnknown(model_.model);
  VectorXd point = calcLowerBounds(unknown);
  for (Index j = 0; j < point.size(); ++j) {
    point[j] += calcWidths(unknown)[j] * (0.15 + 0.7 * drawUniform(test, j));
  }
  return point;
}

ScoredCandidates MachineMaker::score(const VectorXd& point) const {
  const RecordedFeatures empty{layout_, {VectorXd::Zero(extractor_.getFeatureCount())}, {}};
  return scoreCandidates(model_, empty, point);
}

/// A force on a coordinate that forgets itself: Ornstein and Uhlenbeck's, linear between 100 knots.
TermCandidate MachineMaker::makeGust(const std::string& coordinate, int test) const {
  constexpr int kKnots = 101;
  constexpr Index kChannel = 1000;
  const double interval = model_.model.simulation.duration / (kKnots - 1);
  const double forgets = std::exp(-1.0 / (2.0 + 8.0 * drawUniform(test, 101)));  // within 2 to 10 knots
  TableSpec table;
  double value = 0.0;
  for (int i = 0; i < kKnots; ++i) {
    const double step =
        random_.calcNormal(static_cast<std::uint64_t>(test), static_cast<std::uint64_t>(kChannel + i));
    value = i == 0 ? step : forgets * value + std::sqrt(1.0 - forgets * forgets) * step;
    table.times.push_back(interval * i);
    table.values.push_back(value);
  }
  TermCandidate gust;
  gust.term = "process." + coordinate;
  gust.add = [coordinate, table](ModelSpec& model, const std::string& coefficient,
                                 const std::vector<std::string>&) {
    SignalSpec signal;
    signal.name = {"gust", {}};
    signal.unit = "1";
    signal.tables.push_back(table);
    model.excitation.push_back(signal);
    ForceLaw<Expression> law;
    law.coordinate = {coordinate, {}};
    law.force = {coefficient + "*gust", {}};
    model.system.elements.get<ForceLaw>().push_back(law);
  };
  return gust;
}

/// The coefficient of a machine's term behind which chi-square is as many times its mean as was drawn;
/// added: its parameters, the coefficient 0. 0 where it does nothing.
double MachineMaker::drawSize(const ExperimentSpec& machine, const VectorXd& point, const VectorXd& added,
                              int test) const {
  const LinearizedRecordings linear = RecordingsProblem(machine, makeEmptyRecordings(model_, {}))
                                          .linearize(insertAdded(point, shared_, added));
  MatrixXd others(linear.jacobian.rows(), linear.jacobian.cols() - added.size());
  others << linear.jacobian.leftCols(shared_), linear.jacobian.rightCols(others.cols() - shared_);
  const TermScore score =
      ScoreTest(linear.residual, others, linear.jacobian.col(shared_)).calcScore(0, kInfinity);
  const double excess = (drawRatio(test) - 1.0) * static_cast<double>(linear.residual.size());
  return score.visible ? std::sqrt(excess) * score.stddev : 0.0;
}

bool isProcess(const std::string& term) {
  return term.rfind("process.", 0) == 0;
}

}  // namespace twinmap
