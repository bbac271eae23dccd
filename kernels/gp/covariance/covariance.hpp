#pragma once

namespace twinmap::gp {

/// Stationary covariance functions of the scaled distance r, r^2 = sum_i ((x_i - x'_i) / l_i)^2, at unit
/// variance (Rasmussen and Williams, Gaussian Processes for Machine Learning, 2006, section 4.2):
///   squared exponential   exp(-r^2 / 2)
///   Matern 3/2            (1 + sqrt(3) r) exp(-sqrt(3) r)
///   Matern 5/2            (1 + sqrt(5) r + 5 r^2 / 3) exp(-sqrt(5) r)
///   rational quadratic    (1 + r^2 / (2 a))^-a with shape a > 0
enum class CovarianceFunction { kSquaredExponential, kMatern32, kMatern52, kRationalQuadratic };

/// The name used in files and messages: squared_exponential, matern32, matern52, rational_quadratic.
const char* toString(CovarianceFunction covariance);

/// True where the function has the shape hyperparameter a.
bool hasShape(CovarianceFunction covariance);

}  // namespace twinmap::gp
