#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "framework/estimation/bounded_information.hpp"
#include "framework/estimation/posterior/basins/basin_search.hpp"
#include "framework/estimation/refined/misfit.hpp"
#include "kernels/linalg/order.hpp"
#include "tests/framework/estimation/refined/problem.hpp"

namespace twinmap::testing {

/// A noiseless measurement and its misfit, and the basins of points that are known to be minima.
struct Surface {
  Surface(int times, Response response, std::vector<ParameterSpec> parameters, double noise_stddev,
          const Eigen::VectorXd& truth)
      : unknown(std::move(parameters)),
        problem(times, response, unknown, noise_stddev),
        features(response(truth)),
        coordinates(unknown),
        box(unknown, {0, truth.size()}, Eigen::VectorXd::Zero(truth.size())),
        misfit(problem.simulator, problem.model, box, features),
        prior(unknown, {}),
        surface({{&misfit, &problem.model, listIndices(truth.size())}}, coordinates, prior) {}

  std::vector<Basin> makeBasins(const Eigen::MatrixXd& points) {
    std::vector<Basin> basins;
    for (LocalSurface& local : surface.linearize(points)) {
      Eigen::MatrixXd covariance = BoundedInformation(local.information).calcCovariance();
      basins.push_back({std::move(local), std::move(covariance), 3});
    }
    return basins;
  }

  const std::vector<ParameterSpec> unknown;
  Problem problem;
  const Eigen::VectorXd features;
  const LogCoordinates coordinates;
  const SearchBox box;
  Misfit misfit;
  const Prior prior;
  MisfitSurface surface;
};

}  // namespace twinmap::testing
