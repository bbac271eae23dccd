#pragma once

#include <Eigen/Core>
#include <vector>

#include "kernels/gp/model.hpp"

namespace twinmap::gp {

/// `count` evenly spaced indices below `size`.
std::vector<Eigen::Index> spreadIndices(Eigen::Index size, Eigen::Index count);

/// Inducing inputs by pivoted Cholesky factorisation of the covariance: each next one is the candidate whose
/// value is least determined by those before (the greedy choice; Burt, Rasmussen and van der Wilk, JMLR 21,
/// 2020, section 4.1). Candidates are min(n, 8 count) evenly spaced samples, so that the memory is
/// 64 count^2 bytes. Returns d x m, m <= count: it stops where every candidate is determined up to
/// `tolerance` times the largest prior variance (at least 1e-10, below which there is only rounding). Cost: 8
/// count^3 flops.
Eigen::MatrixXd chooseInducingPoints(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                     const ModelStructure& structure, const Hyperparameters& hyperparameters,
                                     Eigen::Index count, double tolerance = 0.0);

}  // namespace twinmap::gp
