#include "framework/optimal_design/excitation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/analysis/identifiability.hpp"
#include "framework/base/files/atomic_file.hpp"
#include "framework/base/log/run_control.hpp"
#include "framework/base/text/csv.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/experiment/check/check_noise.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/point_set.hpp"
#include "framework/optimal_design/design_page.hpp"
#include "framework/optimal_design/excitation_files.hpp"

namespace twinmap::experiment_design {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
namespace fs = std::filesystem;

constexpr int kJudgePoints = 200;    // of the box, for the limits before and after
constexpr int kCheckPoints = 1000;   // random ones at which limits are held against outputs
constexpr Index kMaxVariables = 10;  // whose corners are taken too: there outputs mostly go farthest

/// Keeps one experiment a folder: what design.csv has must be of the same.
void requireFolder(const fs::path& folder, const std::string& text) {
  makeFolders(folder);
  const fs::path file = folder / "experiment.yaml";
  const std::string before = readTextFile(file);
  if (!before.empty() && before != text) {
    throw ExperimentError({folder.string(), 0, 0, ""}, "",
                          "holds the design of another experiment (experiment.yaml); choose another folder");
  }
  writeTextFile(file, text);
}

MatrixXd samplePointsOf(const ExperimentSpec& experiment, DesignMethod method, int count,
                        RandomPurpose purpose) {
  return samplePoints({method, count, {}}, collectSampled(experiment.model), experiment.seed, purpose);
}

/// Random points of the box, and its corners where they are not too many.
MatrixXd makeCheckPoints(const ExperimentSpec& experiment) {
  const MatrixXd random =
      samplePointsOf(experiment, DesignMethod::kUniform, kCheckPoints, RandomPurpose::kDesignCheck);
  const Index variables = random.rows();
  const Index corners = variables <= kMaxVariables ? Index{1} << variables : 0;
  const std::vector<ParameterSpec> sampled = collectSampled(experiment.model);
  const VectorXd center = calcBoxCenter(sampled), half_width = 0.5 * calcWidths(sampled);
  MatrixXd points(variables, random.cols() + corners);
  points.leftCols(random.cols()) = random;
  for (Index corner = 0; corner < corners; ++corner) {
    for (Index v = 0; v < variables; ++v) {
      const double side = ((corner >> v) & 1) != 0 ? 1.0 : -1.0;
      points(v, random.cols() + corner) = center[v] + side * half_width[v];
    }
  }
  return points;
}

/// One search and what it works with.
class ExcitationDesigner {
 public:
  ExcitationDesigner(const ExcitationEvaluator& evaluator, const fs::path& folder, const RunControl& control)
      : evaluator_(evaluator),
        control_(control),
        trials_(folder / "design.csv", evaluator.getNumbers(), evaluator.getLimits()),
        check_points_(makeCheckPoints(evaluator.getExperiment())),
        most_(static_cast<Index>(evaluator.getLimits().size())) {
    for (Index i = 0; i < most_.size(); ++i) {
      most_[i] = evaluator.getLimits()[static_cast<std::size_t>(i)].most;
    }
  }

  DesignSearch makeSearch(const std::string& name, MatrixXd points, int budget) {
    const std::vector<FreeNumber>& numbers = evaluator_.getNumbers();
    const bool phases =
        std::any_of(numbers.begin(), numbers.end(), [](const FreeNumber& number) { return number.is_phase; });
    const auto judge = [this, name, points = std::move(points), budget](const VectorXd& point) {
      return calcScore(name, points, point, budget);
    };
    tried_ = 0;
    best_ = std::numeric_limits<double>::quiet_NaN();
    return {judge, most_, {budget, phases, evaluator_.getExperiment().seed}};
  }

  /// Searches, then tightens limits until they hold at the points of the check.
  void run(DesignSearch& search, int budget) {
    constexpr int kRounds = 6;
    constexpr double kSpare = 0.998;
    search.run(calcPresentPoint(evaluator_.getNumbers()));
    requireAllowed(search, search.findLeastViolation().score, "");
    VectorXd most = most_;
    for (int round = 0; round < kRounds && limitsOutputs(evaluator_.getLimits()); ++round) {
      const DesignScore found = check(search.findBest()->point);
      if (found.failure.empty() && calcViolation(found, most_) <= 0.0) {
        break;
      }
      const VectorXd& seen = search.findBest()->score.measures;
      for (Index i = 0; found.failure.empty() && i < most.size(); ++i) {
        most[i] = found.measures[i] > most_[i]
                      ? std::min(most[i], kSpare * seen[i] * most_[i] / found.measures[i])
                      : most[i];
      }
      search.refine(most, std::max(20, budget / 10));
      requireAllowed(search, found, " at random points within the bounds");
    }
    tightened_ = most.cwiseQuotient(most_);
  }

  JudgedExcitation judge(const VectorXd& values) const {
    JudgedExcitation judged{values, evaluator_.calcLimit(values, check_points_.leftCols(kJudgePoints)),
                            calcSignalMeasures(evaluator_.makeExperiment(values).model),
                            evaluator_.calcMeasures(values, check_points_).measures};
    return judged;
  }

  VectorXd calcValuesOf(const VectorXd& point) const { return calcValues(evaluator_.getNumbers(), point); }
  Index countCheckPoints() const { return check_points_.cols(); }
  const VectorXd& getTightened() const { return tightened_; }
  const TrialFile& getTrials() const { return trials_; }

 private:
  DesignScore check(const VectorXd& point) const {
    return evaluator_.calcMeasures(calcValuesOf(point), check_points_);
  }

  DesignScore calcScore(const std::string& name, const MatrixXd& points, const VectorXd& point, int budget) {
    if (control_.stop != nullptr && *control_.stop) {
      throw Interrupted("interrupted");
    }
    const VectorXd values = calcValuesOf(point);
    const DesignScore* known = trials_.find(name, values);
    const DesignScore score = known != nullptr ? *known : evaluator_.calcScore(values, points);
    trials_.add(name, values, score);
    ++tried_;
    if (control_.progress) {
      tell(score, budget);
    }
    return score;
  }

  void tell(const DesignScore& score, int budget) {
    if (calcViolation(score, most_) <= 0.0 && std::isfinite(score.cost)) {
      best_ = std::isfinite(best_) ? std::min(best_, score.cost) : score.cost;
    }
    Progress progress;
    progress.stage = fmt::format("design, criterion {:.4f}", best_);
    progress.done = std::min(tried_, budget);
    progress.total = budget;
    progress.work = static_cast<double>(progress.done) / budget;
    control_.progress(progress);
  }

  /// Throws where no tried design keeps the limits, naming the worst one of `least`, the one that comes
  /// nearest.
  void requireAllowed(const DesignSearch& search, const DesignScore& least, const std::string& at) const {
    if (search.findBest() != nullptr) {
      return;
    }
    if (!least.failure.empty()) {
      throw std::runtime_error("no excitation within the bounds could be simulated: " + least.failure);
    }
    Index worst = 0;
    (least.measures.array() / most_.array()).maxCoeff(&worst);
    const Limit& limit = evaluator_.getLimits()[static_cast<std::size_t>(worst)];
    throw ExperimentError(
        limit.where, toText(limit.most),
        fmt::format("cannot be kept: of {} excitations within the bounds the one that comes nearest to all "
                    "limits has a {} of {:.4g}{}, {:.3g} % above it",
                    search.getPath().size(), describe(limit), least.measures[worst], at,
                    100.0 * (least.measures[worst] / limit.most - 1.0)));
  }

  const ExcitationEvaluator& evaluator_;
  const RunControl& control_;
  TrialFile trials_;
  MatrixXd check_points_;
  VectorXd most_, tightened_;
  int tried_ = 0;
  double best_ = std::numeric_limits<double>::quiet_NaN();
};

InformationLimit makeInformationLimit(const DesignLimit& limit) {
  InformationLimit information;
  information.stddev = limit.stddev;
  information.mean_information = limit.mean_information;
  information.mean_covariance = limit.mean_covariance;
  return information;
}

/// What a design for the centre of the box alone gives, in the whole box: what robustness costs and brings.
JudgedExcitation designNominal(ExcitationDesigner& designer, const ExperimentSpec& experiment,
                               const std::vector<FreeNumber>& numbers) {
  constexpr int kMaxBudget = 500;
  const int budget = std::min(kMaxBudget, experiment.design.excitation->budget);
  DesignSearch search =
      designer.makeSearch("nominal", calcBoxCenter(collectSampled(experiment.model)), budget);
  search.run(calcPresentPoint(numbers));
  return search.findBest() == nullptr ? JudgedExcitation()
                                      : designer.judge(designer.calcValuesOf(search.findBest()->point));
}

/// Whether the search ended by itself; else its best so far counts.
bool runUnlessStopped(ExcitationDesigner& designer, DesignSearch& search, int budget) {
  try {
    designer.run(search, budget);
    return true;
  } catch (const Interrupted&) {
    if (search.findBest() == nullptr) {
      designer.getTrials().write();
      throw;
    }
    return false;
  }
}

void writeAll(const fs::path& folder, const ExcitationEvaluator& evaluator, const ExcitationDesign& design) {
  writeDesign(folder, evaluator, design);
  writeTextFile(folder / "design.html", makeDesignPage(evaluator, design));
}

}  // namespace

ExcitationDesign designExcitation(const YamlNode& tree, const fs::path& folder, const RunControl& control) {
  YamlNode complete = tree;
  const ExperimentSpec experiment = readExperimentWithSignals(tree);
  requireStatedNoise(experiment);
  if (!experiment.design.excitation) {
    throw ExperimentError(experiment.name.where, "",
                          "needs the key 'design.excitation' to design an excitation");
  }
  const ExcitationDesignSpec& spec = *experiment.design.excitation;
  const std::vector<FreeNumber> numbers = resolveFreeNumbers(spec.free, complete);
  requireFolder(folder, writeYaml(tree));
  const ExcitationEvaluator evaluator(complete, numbers, control.threads);
  ExcitationDesigner designer(evaluator, folder, control);

  ExcitationDesign design;
  design.numbers = numbers;
  design.limits = evaluator.getLimits();
  design.parameters = experiment.model.parameters;
  DesignSearch search = designer.makeSearch("averaged",
                                            samplePointsOf(experiment, DesignMethod::kLatinHypercube,
                                                           spec.average_over, RandomPurpose::kDesignPoints),
                                            spec.budget);
  design.interrupted = !runUnlessStopped(designer, search, spec.budget);
  designer.getTrials().write();
  design.path = search.getPath();
  design.before = designer.judge(designer.calcValuesOf(calcPresentPoint(numbers)));
  design.after = designer.judge(designer.calcValuesOf(search.findBest()->point));
  design.tightened = designer.getTightened();
  design.check_points = static_cast<int>(designer.countCheckPoints());
  design.warnings =
      calcIdentifiability(makeInformationLimit(design.after.limit), experiment.model.parameters).warnings;
  writeAll(folder, evaluator, design);
  if (design.interrupted) {
    throw Interrupted("interrupted; the best design so far is in " + (folder / "designed.yaml").string());
  }
  design.nominal = designNominal(designer, experiment, numbers);
  designer.getTrials().write();
  writeAll(folder, evaluator, design);
  return design;
}

}  // namespace twinmap::experiment_design
