#pragma once

#include <Eigen/Core>
#include <functional>

namespace twinmap {

/// Figures of a set of samples that depend on them through the means of per-sample terms alone (a standard
/// deviation does, through the means of e and e^2): means (k) and number of samples -> figures.
using FigureFunction = std::function<Eigen::VectorXd(const Eigen::VectorXd& mean, double samples)>;

struct JackknifeFigures {
  Eigen::VectorXd value;
  Eigen::VectorXd standard_error;
};

/// The figures of `terms` (k x n) with the jackknife's standard errors (Efron and Stein, The jackknife
/// estimate of variance, Annals of Statistics 9, 1981):
///   se^2 = (n - 1)/n sum_i (f_i - mean f)^2,   f_i the figure without sample i.
/// Of a mean it is sd / sqrt(n) exactly. As figures are functions of means, every f_i costs O(k), all of them
/// O(k n). NaN where a figure without one sample is, as that of a standard deviation of two samples.
///
/// Several draws of one sample (column j + i n / draws of sample j) are left out together, since they are not
/// independent.
JackknifeFigures calcWithJackknife(const Eigen::MatrixXd& terms, const FigureFunction& figures,
                                   int draws = 1);

}  // namespace twinmap
