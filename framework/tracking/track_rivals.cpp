#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/tracking/tracked_twin.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// What is known of one parameter's course: `n` values of weights, and which of the samples they are of.
struct ParameterCourse {
  std::vector<Index> samples;
  VectorXd values, weights;
};

ParameterCourse collectCourse(const std::vector<const CourseSample*>& samples, Index parameter) {
  ParameterCourse course;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (std::isfinite(samples[i]->variances[parameter])) {
      course.samples.push_back(static_cast<Index>(i));
    }
  }
  const auto n = static_cast<Index>(course.samples.size());
  course.values = VectorXd::NullaryExpr(n, [&](Index i) {
    return samples[static_cast<std::size_t>(course.samples[static_cast<std::size_t>(i)])]
        ->estimate[parameter];
  });
  course.weights = VectorXd::NullaryExpr(n, [&](Index i) {
    return 1.0 / samples[static_cast<std::size_t>(course.samples[static_cast<std::size_t>(i)])]
                     ->variances[parameter];
  });
  return course;
}

/// Chi-square that a polynomial of x (one value a sample) leaves of a course. A line is what a step is; a
/// parabola has as many numbers as a step with its time. Infinite where x does not vary.
double calcLeft(const VectorXd& x, int degree, const ParameterCourse& course) {
  const VectorXd own = x(course.samples);
  const double size = own.cwiseAbs().maxCoeff();
  const VectorXd off = (own.array() - own.mean()) / (size > 0.0 ? size : 1.0);
  MatrixXd columns = MatrixXd::Ones(own.size(), degree + 1);
  for (int power = 1; power <= degree; ++power) {
    columns.col(power) = columns.col(power - 1).cwiseProduct(off);
  }
  const VectorXd root = course.weights.cwiseSqrt();
  const MatrixXd weighted = root.asDiagonal() * columns;
  const VectorXd values = root.cwiseProduct(course.values);
  const linalg::LinearFit fit = linalg::fitLinear(weighted, values);
  return fit.rank < 2 ? std::numeric_limits<double>::infinity()
                      : (values - weighted * fit.coefficients).squaredNorm();
}

/// By how much chi-square a parabola of x is worse than a step, of all courses together. Of a parameter that
/// scatters by more than its measurements say, differences count for less.
double calcWorse(const VectorXd& x, const VectorXd& step, const std::vector<ParameterCourse>& courses) {
  double worse = 0.0;
  for (const ParameterCourse& course : courses) {
    const double left = calcLeft(step, 1, course);
    const double degrees = std::max(1.0, static_cast<double>(course.values.size() - 3));
    worse += (calcLeft(x, 2, course) - left) / std::max(1.0, left / degrees);
  }
  return worse;
}

/// The values of a covariate; empty where a measurement lacks it.
VectorXd collect(const std::vector<const CourseSample*>& samples, const std::string& name) {
  VectorXd values(static_cast<Index>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::vector<Covariate>& covariates = samples[i]->covariates;
    const auto found = std::find_if(covariates.begin(), covariates.end(),
                                    [&](const Covariate& covariate) { return covariate.name == name; });
    if (found == covariates.end()) {
      return {};
    }
    values[static_cast<Index>(i)] = found->value;
  }
  return values;
}

}  // namespace

std::vector<std::string> findRivals(const std::deque<CourseSample>& course,
                                    const std::vector<Eigen::Index>& parameters, double change) {
  const double as_likely = 2.0 * std::log(20.0);  // of chi-square
  std::vector<const CourseSample*> samples;
  for (const CourseSample& sample : course) {
    samples.push_back(&sample);
  }
  std::vector<ParameterCourse> courses;
  for (const Index j : parameters) {
    if (ParameterCourse one = collectCourse(samples, j); one.values.size() > 0) {
      courses.push_back(std::move(one));
    }
  }
  std::vector<std::string> rivals;
  if (courses.empty()) {
    return rivals;
  }
  const VectorXd step = VectorXd::NullaryExpr(static_cast<Index>(samples.size()), [&](Index i) {
    return samples[static_cast<std::size_t>(i)]->time >= change ? 1.0 : 0.0;
  });
  for (const Covariate& covariate : samples.back()->covariates) {
    const VectorXd x = collect(samples, covariate.name);
    if (x.size() > 0 && calcWorse(x, step, courses) < as_likely) {
      rivals.push_back(covariate.name);
    }
  }
  return rivals;
}

std::vector<std::string> findRecurringRivals(const std::vector<TrackAlarm>& alarms, double since) {
  constexpr std::ptrdiff_t kRecurs = 2;
  std::vector<std::string> named, recurring;
  for (const TrackAlarm& alarm : alarms) {
    if (alarm.announced >= since) {
      named.insert(named.end(), alarm.rivals.begin(), alarm.rivals.end());
    }
  }
  for (const std::string& name : named) {
    if (std::count(named.begin(), named.end(), name) >= kRecurs &&
        std::find(recurring.begin(), recurring.end(), name) == recurring.end()) {
      recurring.push_back(name);
    }
  }
  return recurring;
}

}  // namespace twinmap
