#include "framework/estimation/posterior/draws/local_walk.hpp"

#include <cmath>
#include <optional>

#include "framework/base/random/random.hpp"
#include "framework/estimation/box_points.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using importance::NormalPart;

namespace {

/// The posterior of the linearised response with `information` as that of a prior about its point; with the
/// Cholesky factor of its own information.
struct LocalPosterior {
  VectorXd mean;
  MatrixXd factor;
};

LocalPosterior calcLocalPosterior(const LocalSurface& local, const MatrixXd& near) {
  LocalPosterior posterior;
  posterior.factor = linalg::calcCholesky(local.information + near).lower;
  posterior.mean = local.at + linalg::solveCholesky(posterior.factor, local.descent);
  return posterior;
}

double calcLogDensity(const LocalPosterior& posterior, const VectorXd& point) {
  return posterior.factor.diagonal().array().log().sum() -
         0.5 * (posterior.factor.transpose() * (point - posterior.mean)).squaredNorm();
}

/// Steps of one length in half-widths reach across flat valleys, others round sharp bends.
MatrixXd drawReach(Index dimensions, double uniform) {
  constexpr double kShortest = 0.05, kLongest = 1.0;  // half-widths
  const double reach = kShortest * std::pow(kLongest / kShortest, uniform);
  return MatrixXd::Identity(dimensions, dimensions) / (reach * reach);
}

class Walk {
 public:
  Walk(MisfitSurface& surface, std::vector<LocalSurface> from, std::uint64_t seed)
      : surface_(surface), at_(std::move(from)), random_(seed, RandomPurpose::kPosteriorWalk) {}

  void step() {
    const Index u = surface_.getDimensions();
    std::vector<std::size_t> moved;
    std::vector<MatrixXd> reaches;
    MatrixXd points(u, 0);
    for (std::size_t k = 0; k < at_.size(); ++k) {
      const auto chain = static_cast<std::uint64_t>(k);
      const MatrixXd near = drawReach(u, random_.calcUniform(chain, 0, steps_));
      VectorXd normals(u);
      random_.drawNormals(chain, steps_, normals.data(), static_cast<std::size_t>(u));
      const LocalPosterior own = calcLocalPosterior(at_[k], near);
      const VectorXd point = own.mean + own.factor.transpose().triangularView<Eigen::Upper>().solve(normals);
      if (isInBox(point)) {
        points.conservativeResize(Eigen::NoChange, points.cols() + 1);
        points.rightCols(1) = point;
        moved.push_back(k);
        reaches.push_back(near);
      }
    }
    if (!moved.empty()) {
      accept(surface_.linearize(points), moved, reaches);
    }
    ++steps_;
  }

  MatrixXd listPlaces() const {
    MatrixXd places(surface_.getDimensions(), static_cast<Index>(at_.size()));
    for (std::size_t k = 0; k < at_.size(); ++k) {
      places.col(static_cast<Index>(k)) = at_[k].at;
    }
    return places;
  }

 private:
  double calcLogPosterior(const LocalSurface& local) const {
    return -0.5 * local.loss + surface_.calcLogPrior(local.at);
  }

  void accept(std::vector<LocalSurface> reached, const std::vector<std::size_t>& moved,
              const std::vector<MatrixXd>& reaches) {
    for (std::size_t i = 0; i < moved.size(); ++i) {
      LocalSurface& from = at_[moved[i]];
      LocalSurface& to = reached[i];
      if (!to.simulated) {
        continue;
      }
      const double log_ratio = calcLogPosterior(to) - calcLogPosterior(from) +
                               calcLogDensity(calcLocalPosterior(to, reaches[i]), from.at) -
                               calcLogDensity(calcLocalPosterior(from, reaches[i]), to.at);
      if (std::log(random_.calcUniform(static_cast<std::uint64_t>(moved[i]), 1, steps_)) < log_ratio) {
        from = std::move(to);
      }
    }
  }

  MisfitSurface& surface_;
  std::vector<LocalSurface> at_;  // of the chains
  const RandomStream random_;
  std::uint64_t steps_ = 0;
};

}  // namespace

std::vector<NormalPart> linearizeAt(MisfitSurface& surface, const MatrixXd& points, const MatrixXd& lower) {
  const MatrixXd identity = MatrixXd::Identity(lower.rows(), lower.rows());
  const MatrixXd near = linalg::solveCholesky(lower, identity);
  std::vector<NormalPart> parts;
  for (const LocalSurface& local : surface.linearize(points)) {
    if (local.simulated) {
      const LocalPosterior posterior = calcLocalPosterior(local, near);
      parts.push_back({0.0, clampToBox(posterior.mean),
                       linalg::calcCholesky(linalg::solveCholesky(posterior.factor, identity)).lower});
    }
  }
  return parts;
}

MatrixXd walkPosterior(MisfitSurface& surface, const MatrixXd& starts, int steps, std::uint64_t seed) {
  std::vector<LocalSurface> from;
  for (LocalSurface& local : surface.linearize(starts)) {
    if (local.simulated) {
      from.push_back(std::move(local));
    }
  }
  const auto chains = static_cast<Index>(from.size());
  Walk walk(surface, std::move(from), seed);
  const int kept = steps / 2;
  MatrixXd places(surface.getDimensions(), chains * kept);
  for (int step = 0; step < steps; ++step) {
    walk.step();
    if (step >= steps - kept) {
      places.middleCols((step - (steps - kept)) * chains, chains) = walk.listPlaces();
    }
  }
  return places;
}

}  // namespace twinmap
