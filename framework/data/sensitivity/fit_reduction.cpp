#include "framework/data/sensitivity/fit_reduction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "framework/base/random/random.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/data/sensitivity/stencil_simulator.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/point_set.hpp"
#include "framework/simulation/simulator_team.hpp"
#include "framework/simulation/stencil.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kPoints = 48, kCheckPoints = 12;
constexpr double kLeftOut = 3e-4;
constexpr Index kColumns = 32, kFewest = 4;  // of the sketch; scores of a window

/// A response and its sensitivities (per width of the bounds), in units of the noise.
struct Simulated {
  VectorXd response;
  MatrixXd sensitivities;  // rows x u
  SampleStatus status;
};

/// The information of all samples with that of uniform parameters, so that it is regular.
MatrixXd addPrior(MatrixXd information) {
  information.diagonal().array() += kUniformInformation;
  return information;
}

class ReductionFit {
 public:
  ReductionFit(const Simulator& prototype, const ExperimentSpec& experiment, const RunControl& control)
      : prototype_(prototype),
        experiment_(experiment),
        control_(control),
        unknown_(collectUnknown(experiment.model)),
        random_(experiment.seed, RandomPurpose::kReduction) {
    reduction_.windows = partResponse(experiment, prototype.getLayout());
    const VectorXd stddev = calcNoiseStddev(experiment.noise, prototype.getLayout());
    reduction_.center = reduction_.inverse_stddev = VectorXd::Zero(stddev.size());
    for (const ReductionWindow& window : reduction_.windows) {
      reduction_.inverse_stddev(window.rows) = stddev(window.rows).cwiseInverse();
      sketch_.emplace_back(MatrixXd::Zero(static_cast<Index>(window.rows.size()), kColumns));
    }
  }

  ResponseReduction fit() {
    const std::vector<ParameterSpec> sampled = collectSampled(experiment_.model);
    PointSetSpec sobol;
    sobol.method = DesignMethod::kSobol;
    sobol.samples = static_cast<int>(kPoints + kCheckPoints);
    const MatrixXd points = samplePoints(sobol, sampled, experiment_.seed, RandomPurpose::kReduction);
    simulateCenter(calcBoxCenter(sampled));
    forEach(points.leftCols(kPoints), [&](Index i, const Simulated& at) { addToSketch(i, at); });
    chooseDirections();
    checkLoss(points.rightCols(kCheckPoints));
    return std::move(reduction_);
  }

 private:
  Simulated simulate(Simulator& simulator, const VectorXd& point) const {
    const Index rows = prototype_.getLayout().getRowCount(), columns = countNeighbours(unknown_.size());
    MatrixXd stencil(rows * columns, 1);
    Simulated at;
    simulateStencils(simulator, unknown_, point, stencil, &at.status);
    if (at.status.ok) {
      const Eigen::Map<const MatrixXd> responses(stencil.data(), rows, columns);
      const auto scale = reduction_.inverse_stddev.asDiagonal();
      at.response = scale * (responses.col(0) - reduction_.center);
      at.sensitivities = scale * calcDifferences(responses, unknown_, point);
    }
    return at;
  }

  void simulateCenter(const MatrixXd& point) {
    const std::unique_ptr<Simulator> simulator = prototype_.clone();
    MatrixXd response(reduction_.center.size(), 1);
    SampleStatus status;
    simulator->simulate(point, response, &status);
    if (status.ok) {  // else any other would do as well
      reduction_.center = response.col(0);
    }
  }

  /// Simulates some points at a time, and takes those that did not fail one after another.
  template <class Take>
  void forEach(const MatrixXd& points, const Take& take) {
    constexpr Index kNumbers = 32 << 20, kMostAtOnce = 16;
    const Index each = prototype_.getLayout().getRowCount() * (countNeighbours(unknown_.size()) + 1);
    const Index at_once = std::clamp<Index>(kNumbers / each, 2, kMostAtOnce);
    Index taken = 0;
    SampleStatus failed;
    for (Index first = 0; first < points.cols(); first += at_once) {
      throwIfCancelled(control_);
      std::vector<Simulated> simulated(
          static_cast<std::size_t>(std::min<Index>(at_once, points.cols() - first)));
      runOnTeam(prototype_, static_cast<int>(simulated.size()), control_.threads,
                [&](Simulator& simulator, int i) {
                  simulated[static_cast<std::size_t>(i)] = simulate(simulator, points.col(first + i));
                });
      for (std::size_t i = 0; i < simulated.size(); ++i) {
        failed = simulated[i].status.ok ? failed : simulated[i].status;
        if (simulated[i].status.ok) {
          take(first + static_cast<Index>(i), simulated[i]);
          ++taken;
        }
      }
    }
    if (taken == 0) {
      throw std::runtime_error("samples cannot be reduced, for no simulation succeeds: " + failed.reason);
    }
  }

  void addToSketch(Index point, const Simulated& at) {
    const Index u = at.sensitivities.cols();
    MatrixXd columns(at.response.size(), u + 1);
    const linalg::Cholesky factor =
        linalg::calcCholesky(addPrior(at.sensitivities.transpose() * at.sensitivities));
    columns.leftCols(u) = linalg::solveLower(factor.lower, at.sensitivities.transpose()).transpose();
    // Of unit length, or, where that is more, so long that what is left out is a hundredth of the noise.
    constexpr double kOfNoise = 0.01;
    const double longer = std::sqrt(kLeftOut * static_cast<double>(u + 1) /
                                    (kOfNoise * static_cast<double>(reduction_.countSamples())));
    columns.col(u) = at.response *
                     std::max(longer, 1.0 / std::max(at.response.norm(), std::numeric_limits<double>::min()));
    allowed_ += kLeftOut * static_cast<double>((u + 1) * kColumns);
    MatrixXd weights(u + 1, kColumns);
    random_.drawNormals(static_cast<std::uint64_t>(point), 0, weights.data(),
                        static_cast<std::size_t>(weights.size()));
    for (std::size_t w = 0; w < sketch_.size(); ++w) {
      sketch_[w] += columns(reduction_.windows[w].rows, Eigen::all) * weights;
    }
  }

  void chooseDirections() {
    std::vector<linalg::SymmetricEigen> decomposed;
    VectorXd said = VectorXd::Zero(kColumns);
    Index fewest = kMostScores;
    for (const MatrixXd& part : sketch_) {
      decomposed.push_back(linalg::calcSymmetricEigen(part.transpose() * part));
      said += decomposed.back().values.reverse().cwiseMax(0.0);
      fewest = std::min(fewest, part.rows() / 2);
    }
    Index scores = std::min(kFewest, fewest);
    while (scores < fewest && said.tail(kColumns - scores).sum() > allowed_) {
      ++scores;
    }
    for (std::size_t w = 0; w < sketch_.size(); ++w) {
      setDirections(w, sketch_[w] * decomposed[w].vectors.rowwise().reverse().leftCols(scores));
      sketch_[w].resize(0, 0);
    }
    reduction_.layout =
        makeReducedLayout(static_cast<Index>(sketch_.size()), scores, experiment_.model.simulation.duration);
  }

  /// Orthonormal ones that span the columns given, leading first; any beside them where these say nothing.
  void setDirections(std::size_t w, MatrixXd directions) {
    constexpr double kNothing = 1e-6;  // of the leading one: the eigenvalues' square roots are no better
    const double least = kNothing * directions.col(0).norm();
    for (Index k = 0; k < directions.cols(); ++k) {
      auto own = directions.col(k);
      if (own.norm() <= least) {
        random_.drawNormals(static_cast<std::uint64_t>(kPoints) + w, static_cast<std::uint64_t>(k),
                            own.data(), static_cast<std::size_t>(own.size()));
      }
      for (int pass = 0; pass < 2; ++pass) {  // once leaves rounding errors of what was taken off
        own -= directions.leftCols(k) * VectorXd(directions.leftCols(k).transpose() * own);
        own.normalize();
      }
    }
    reduction_.windows[w].directions = directions.cast<float>();
  }

  /// At other points: what is lost, and what the directions leave of a clean response.
  void checkLoss(const MatrixXd& points) {
    const auto p = static_cast<Index>(experiment_.model.parameters.size());
    VectorXd ratios = VectorXd::Zero(p), left = VectorXd::Zero(static_cast<Index>(sketch_.size()));
    double count = 0.0;
    forEach(points, [&](Index, const Simulated& at) {
      MatrixXd kept = MatrixXd::Zero(at.sensitivities.cols(), at.sensitivities.cols());
      for (std::size_t w = 0; w < reduction_.windows.size(); ++w) {
        const ReductionWindow& window = reduction_.windows[w];
        const MatrixXd directions = window.directions.cast<double>();
        const MatrixXd scores = directions.transpose() * at.sensitivities(window.rows, Eigen::all);
        kept += scores.transpose() * scores;
        const VectorXd response = at.response(window.rows);
        left[static_cast<Index>(w)] +=
            (response - directions * VectorXd(directions.transpose() * response)).squaredNorm();
      }
      const MatrixXd all = at.sensitivities.transpose() * at.sensitivities;
      ratios += (calcVariances(kept).array() / calcVariances(all).array()).sqrt().matrix().head(p);
      count += 1.0;
    });
    reduction_.stddev_ratio = ratios / count;
    for (std::size_t w = 0; w < reduction_.windows.size(); ++w) {
      setScales(left[static_cast<Index>(w)] / count, reduction_.windows[w]);
    }
  }

  static VectorXd calcVariances(const MatrixXd& information) {
    return linalg::invertPositiveDefinite(addPrior(information)).diagonal();
  }

  const Simulator& prototype_;
  const ExperimentSpec& experiment_;
  const RunControl& control_;
  const std::vector<ParameterSpec> unknown_;
  const RandomStream random_;
  ResponseReduction reduction_;
  std::vector<MatrixXd> sketch_;  // of each window, samples x kColumns
  double allowed_ = 0.0;          // of the sketch's squares, to be left out
};

}  // namespace

ResponseReduction fitReduction(const Simulator& prototype, const ExperimentSpec& experiment,
                               const RunControl& control) {
  return ReductionFit(prototype, experiment, control).fit();
}

}  // namespace twinmap
