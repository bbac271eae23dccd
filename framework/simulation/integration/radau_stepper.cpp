#include "framework/simulation/integration/radau_stepper.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "framework/simulation/integration/first_step.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const double kRoot6 = std::sqrt(6.0);

/// Times of the stages, in steps.
const std::array<double, 3> kTimes{(4.0 - kRoot6) / 10.0, (4.0 + kRoot6) / 10.0, 1.0};

/// The method's coefficients: stages z = h A f(x + z).
const Eigen::Matrix3d& getCoefficients() {
  static const Eigen::Matrix3d kCoefficients =
      (Eigen::Matrix3d() << (88.0 - 7.0 * kRoot6) / 360.0, (296.0 - 169.0 * kRoot6) / 1800.0,
       (-2.0 + 3.0 * kRoot6) / 225.0, (296.0 + 169.0 * kRoot6) / 1800.0, (88.0 + 7.0 * kRoot6) / 360.0,
       (-2.0 - 3.0 * kRoot6) / 225.0, (16.0 - kRoot6) / 36.0, (16.0 + kRoot6) / 36.0, 1.0 / 9.0)
          .finished();
  return kCoefficients;
}

constexpr double kRealEigenvalue = 3.6378342527444957;  // of the inverse of the coefficients

class RadauStepper final : public HybridStepper {
 public:
  explicit RadauStepper(const IntegrationOptions& options) : options_(options) {}

  bool tryStep(OdeProblem& problem, const Point& from, Point& to, double& dt) override {
    constexpr double kIterationError = 1e-3;  // of the tolerance
    const double h = dt;
    begin(problem, from, h);
    if (!iterate(problem, from, h, kIterationError)) {
      dt = 0.5 * h;
      fresh_ = false;
      return fail(from, to);
    }
    const double error = calcError(problem, from, h);
    const double factor = 0.9 * std::pow(std::max(error, 1e-8), -0.25);  // the estimate is of order 3
    dt = h * std::clamp(std::isfinite(factor) ? factor : 0.2, 0.2, fresh_ ? 8.0 : 1.0);
    fresh_ = error <= 1.0;
    if (!fresh_) {
      return fail(from, to);
    }
    finish(problem, from, from.t + h, to);
    return true;
  }

  void doStep(OdeProblem& problem, const Point& from, double t_new, Point& to) override {
    constexpr double kIterationError = 1e-6;  // of the tolerance: differences of neighbours are taken
    begin(problem, from, t_new - from.t);
    if (!iterate(problem, from, t_new - from.t, kIterationError)) {
      stages_.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    finish(problem, from, t_new, to);
  }

  /// The polynomial through the beginning and the stages.
  void interpolate(double t, const Point& from, const Point& to, State& x) override {
    const double s = (t - from.t) / (to.t - from.t);
    x = from.x;
    for (Index k = 0; k < 3; ++k) {
      double weight = s / kTimes[k];
      for (Index j = 0; j < 3; ++j) {
        weight *= j == k ? 1.0 : (s - kTimes[j]) / (kTimes[k] - kTimes[j]);
      }
      for (std::size_t i = 0; i < x.size(); ++i) {
        x[i] += weight * stages_(static_cast<Index>(i), k);
      }
    }
  }

  bool interpolatesAccurately() const override { return false; }

 private:
  /// For integration and its neighbours' replay alike: all that enters a step but its size.
  void begin(OdeProblem& problem, const Point& from, double h) {
    const auto n = static_cast<Index>(from.x.size());
    stages_ = MatrixXd::Zero(n, 3);
    slopes_.resize(n, 3);
    moved_ = from.x;
    slope_.resize(from.x.size());
    if (n > 0) {
      calcJacobian(problem, from);
    }
    const Eigen::Matrix3d& coefficients = getCoefficients();
    matrix_.setIdentity(3 * n, 3 * n);
    for (Index i = 0; i < 3; ++i) {
      for (Index j = 0; j < 3; ++j) {
        matrix_.block(n * i, n * j, n, n) -= h * coefficients(i, j) * jacobian_;
      }
    }
  }

  void calcJacobian(OdeProblem& problem, const Point& from) {
    jacobian_.resize(stages_.rows(), stages_.rows());
    if (problem.calcJacobian(from.t, from.x, jacobian_)) {
      return;
    }
    const double relative = std::sqrt(std::numeric_limits<double>::epsilon());
    const double smallest = options_.absolute_tolerance / options_.relative_tolerance;  // that counts
    for (std::size_t j = 0; j < from.x.size(); ++j) {
      moved_[j] += relative * std::max(std::abs(from.x[j]), smallest);
      problem.calcDerivative(from.t, moved_, slope_);
      for (std::size_t i = 0; i < from.x.size(); ++i) {
        jacobian_(static_cast<Index>(i), static_cast<Index>(j)) =
            (slope_[i] - from.dxdt[i]) / (moved_[j] - from.x[j]);
      }
      moved_[j] = from.x[j];
    }
  }

  void calcSlopes(OdeProblem& problem, const Point& from, double h) {
    for (Index k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < moved_.size(); ++i) {
        moved_[i] = from.x[i] + stages_(static_cast<Index>(i), k);
      }
      problem.calcDerivative(from.t + kTimes[k] * h, moved_, slope_);
      slopes_.col(k) = Eigen::Map<const VectorXd>(slope_.data(), stages_.rows());
    }
  }

  /// Newton iterations for the stages; false where they do not converge.
  bool iterate(OdeProblem& problem, const Point& from, double h, double accuracy) {
    constexpr int kMaxIterations = 12;
    double before = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kMaxIterations; ++i) {
      calcSlopes(problem, from, h);
      const MatrixXd residual = h * slopes_ * getCoefficients().transpose() - stages_;
      const MatrixXd change = linalg::solveLinear(matrix_, residual.reshaped()).reshaped(stages_.rows(), 3);
      stages_ += change;
      const double size = calcNorm(change, from);
      const double rounding = 1e-13 / options_.relative_tolerance;  // changes that are rounding only
      if (size <= std::max(accuracy, rounding)) {
        return true;
      }
      if (!(size < 2.0 * before) || !std::isfinite(size)) {
        return false;
      }
      before = size;
    }
    return false;
  }

  /// The difference to a method of order 3 (IV.8), in tolerances; 1 is what may be.
  double calcError(OdeProblem& problem, const Point& from, double h) {
    const Index n = stages_.rows();
    const double share = 1.0 / kRealEigenvalue;
    const Eigen::Vector3d weights =
        share / 3.0 * Eigen::Vector3d(-13.0 - 7.0 * kRoot6, -13.0 + 7.0 * kRoot6, -1.0);
    const MatrixXd matrix = MatrixXd::Identity(n, n) - h * share * jacobian_;
    const VectorXd own = stages_ * weights;
    const auto estimate = [&](const State& dxdt) -> VectorXd {
      return linalg::solveLinear(matrix, own + h * share * Eigen::Map<const VectorXd>(dxdt.data(), n));
    };
    if (n == 0) {
      return 0.0;
    }
    VectorXd error = estimate(from.dxdt);
    if (!fresh_ || calcNorm(error, from) > 1.0) {  // filtered once more: what decays at once is no error
      for (Index i = 0; i < n; ++i) {
        moved_[static_cast<std::size_t>(i)] = from.x[static_cast<std::size_t>(i)] + error[i];
      }
      problem.calcDerivative(from.t, moved_, slope_);
      error = estimate(slope_);
    }
    return calcNorm(error, from);
  }

  /// Root mean square in tolerances.
  double calcNorm(const MatrixXd& values, const Point& from) const {
    double sum = 0.0;
    for (Index i = 0; i < values.rows(); ++i) {
      const double scale = options_.absolute_tolerance +
                           options_.relative_tolerance * std::abs(from.x[static_cast<std::size_t>(i)]);
      sum += values.row(i).squaredNorm() / (scale * scale);
    }
    return std::sqrt(sum / static_cast<double>(std::max<Index>(values.size(), 1)));
  }

  void finish(OdeProblem& problem, const Point& from, double t_new, Point& to) {
    to.t = t_new;
    for (std::size_t i = 0; i < from.x.size(); ++i) {
      to.x[i] = from.x[i] + stages_(static_cast<Index>(i), 2);
    }
    problem.calcDerivative(to.t, to.x, to.dxdt);
  }

  static bool fail(const Point& from, Point& to) {
    to = from;  // finite: the step is too large, not the state lost
    return false;
  }

  IntegrationOptions options_;
  MatrixXd stages_, slopes_, jacobian_, matrix_;  ///< stages_: x at the stages less x at the beginning
  State moved_, slope_;
  bool fresh_ = true;  ///< the step before was accepted
};

}  // namespace

std::unique_ptr<HybridStepper> makeRadauStepper(const IntegrationOptions& options) {
  return std::make_unique<RadauStepper>(options);
}

}  // namespace twinmap
