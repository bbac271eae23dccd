#pragma once

#include <Eigen/Core>
#include <complex>
#include <memory>
#include <string>
#include <vector>

#include "framework/data/features/feature_block.hpp"
#include "framework/experiment/feature_spec.hpp"

namespace twinmap {

/// One complex feature: the sum of weights[i] times row rows[i] of a response.
struct ComplexLine {
  std::string name;  ///< "y" or "y/F"
  std::string unit;
  int output = -1;
  double frequency = 0.0;  ///< Hz
  std::vector<Eigen::Index> rows;
  Eigen::VectorXcd weights;
  std::string excitation{};  ///< the signal that it is the response to; empty of a spectrum
};

/// Weights of a line of the discrete Fourier transform, of t = 0 and scaled by amplitude:
/// 2 w_i / (sum of w) exp(-j 2 pi f t_i), so that A sin(2 pi f t + phi) on a line gives A exp(j (phi -
/// pi/2)). The Hann window is the periodic one, 0.5 - 0.5 cos(2 pi i / count).
Eigen::VectorXcd calcLineWeights(const WindowSpec& window, const Frequency& frequency,
                                 WindowFunction window_function);

/// Real and imaginary part of each line (linear), or its magnitude and the cosine and sine of its phase.
/// `rows`: of a response.
std::shared_ptr<const FeatureBlock> makeComplexBlock(const std::vector<ComplexLine>& lines,
                                                     ComplexParts parts, Eigen::Index rows);

}  // namespace twinmap
