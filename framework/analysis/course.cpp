#include "framework/analysis/course.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "framework/base/random/random.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kReplicates = 1999;
constexpr Index kMostPlaces = 64;

/// One shape of a change at one place; its regressor is a column of `Changes::regressors`.
struct Change {
  CourseShape shape;
  Index begins;
};

/// All changes that are tried, in units of the errors: each regressor over the standard deviations, without
/// its weighted mean, of length one.
struct Changes {
  std::vector<Change> list;
  MatrixXd regressors;  ///< n x changes
  VectorXd lengths;     ///< before they were divided by them
  VectorXd weights;     ///< 1 / stddev, of length one: the regressor of a constant
};

VectorXd makeShape(const Change& change, const VectorXd& at) {
  return at.binaryExpr(VectorXd::LinSpaced(at.size(), 0.0, static_cast<double>(at.size() - 1)),
                       [&](double place, double index) {
                         return change.shape == CourseShape::kStep
                                    ? (index >= static_cast<double>(change.begins) ? 1.0 : 0.0)
                                    : std::max(0.0, place - at[change.begins]);
                       });
}

/// At kMostPlaces from `first` to before `last` (at most n - 2), or all of these.
Changes listChanges(const VectorXd& stddevs, const VectorXd& at, Index first, Index last) {
  const Index n = at.size(), places = std::min(last - first, kMostPlaces);
  Changes changes;
  for (Index k = 0; k < places; ++k) {
    const Index place = first + k * (last - first) / places;
    changes.list.push_back({CourseShape::kStep, place + 1});
    changes.list.push_back({CourseShape::kRamp, place});
  }
  const auto count = static_cast<Index>(changes.list.size());
  const VectorXd weights = stddevs.cwiseInverse();
  changes.weights = weights.normalized();
  changes.regressors.resize(n, count);
  changes.lengths.resize(count);
  for (Index c = 0; c < count; ++c) {
    VectorXd column = makeShape(changes.list[static_cast<std::size_t>(c)], at).cwiseProduct(weights);
    column -= changes.weights.dot(column) * changes.weights;
    changes.lengths[c] = column.norm();
    changes.regressors.col(c) = column / changes.lengths[c];
  }
  return changes;
}

/// All between a change and its neighbours among kMostPlaces.
Changes listNear(const Change& change, const VectorXd& stddevs, const VectorXd& at) {
  const Index last = at.size() - 2, apart = (last + kMostPlaces - 1) / kMostPlaces;
  return listChanges(stddevs, at, std::max<Index>(0, change.begins - apart),
                     std::min(last, change.begins + apart));
}

/// What the best change takes of the sum of squares of errors without their constant, and what it leaves.
struct Gain {
  Index best = 0;
  double gain = 0.0, left = 0.0;

  /// Compared with the stated errors, or with what is left.
  double get(bool scattered) const { return scattered ? gain / left : gain; }
};

Gain findGain(const Changes& changes, const VectorXd& errors) {
  const VectorXd centred = errors - changes.weights.dot(errors) * changes.weights;
  const VectorXd coefficients = changes.regressors.transpose() * centred;
  Gain found;
  found.gain = coefficients.cwiseAbs2().maxCoeff(&found.best);
  found.left = centred.squaredNorm() - found.gain;
  return found;
}

double calcPValue(const Changes& changes, const Gain& found, bool scattered, std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::kCourse);
  VectorXd errors(changes.regressors.rows());
  int above = 0;
  for (int replicate = 0; replicate < kReplicates; ++replicate) {
    random.drawNormals(static_cast<std::uint64_t>(replicate), 0, errors.data(),
                       static_cast<std::size_t>(errors.size()));
    above += findGain(changes, errors).get(scattered) >= found.get(scattered) ? 1 : 0;
  }
  return (1.0 + above) / (1.0 + kReplicates);
}

/// Whether a sum of squares is larger than errors of the stated size leave, at a level of 1 %.
bool isScattered(double sum, Index degrees) {
  constexpr double kLevel = 0.01;
  const boost::math::chi_squared distribution(static_cast<double>(degrees));
  return sum > boost::math::quantile(complement(distribution, kLevel));
}

void requireSizes(const VectorXd& values, const VectorXd& stddevs, const VectorXd& at) {
  if (values.size() < kFewestOfCourse || stddevs.size() != values.size() || at.size() != values.size() ||
      !(stddevs.minCoeff() > 0.0)) {
    throw std::invalid_argument("fitCourse: needs six values, their standard deviations and places");
  }
}

}  // namespace

Course fitCourse(const VectorXd& values, const VectorXd& stddevs, const VectorXd& at, double level,
                 std::uint64_t seed) {
  requireSizes(values, stddevs, at);
  const Index degrees = values.size() - 2;
  const VectorXd errors = values.cwiseQuotient(stddevs);
  const Changes spread = listChanges(stddevs, at, 0, degrees);
  const Gain among = findGain(spread, errors);
  const Changes changes = listNear(spread.list[static_cast<std::size_t>(among.best)], stddevs, at);
  const Gain found = findGain(changes, errors);
  const bool scattered = isScattered(found.left, degrees);
  Course course;
  course.p_value = calcPValue(spread, among, scattered, seed);
  VectorXd explained = changes.weights.dot(errors) * changes.weights;
  double left = found.left + found.gain;
  if (course.p_value < level) {
    const Change& change = changes.list[static_cast<std::size_t>(found.best)];
    const double coefficient = changes.regressors.col(found.best).dot(errors);
    const double reach = change.shape == CourseShape::kRamp ? at[at.size() - 1] - at[change.begins] : 1.0;
    course.shape = change.shape;
    course.begins = change.begins;
    course.change = reach * coefficient / changes.lengths[found.best];
    course.change_stddev = reach / changes.lengths[found.best];
    explained += coefficient * changes.regressors.col(found.best);
    left = found.left;
  }
  course.fitted = explained.cwiseProduct(stddevs);
  course.scatter = std::sqrt(left / static_cast<double>(degrees + (course.change_stddev > 0.0 ? 0 : 1)));
  course.change_stddev *= scattered ? course.scatter : 1.0;
  return course;
}

}  // namespace twinmap
