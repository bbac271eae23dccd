#pragma once

#include <Eigen/Core>

namespace twinmap {

enum class CourseShape {
  kConstant,
  kStep,  ///< one level before, another from a measurement on
  kRamp,  ///< constant up to a measurement, then linear
};

/// How a quantity went over measurements in order.
struct Course {
  CourseShape shape = CourseShape::kConstant;
  Eigen::Index begins = 0;     ///< kStep: the first measurement of the new level; kRamp: the last of the old
  Eigen::VectorXd fitted;      ///< at each measurement
  double change = 0.0;         ///< of a step; of a ramp, from its beginning to the last measurement
  double change_stddev = 0.0;  ///< given the shape and where it begins
  double scatter = 1.0;        ///< about `fitted`, in the stated standard deviations
  double p_value = 1.0;        ///< of no change
};

/// The least measurements of which a course is asked: two levels and a scatter about them.
constexpr Eigen::Index kFewestOfCourse = 6;

/// The course of n >= kFewestOfCourse values with independent normal errors of the given standard deviations,
/// at increasing places `at` (numbers of measurements, or times). Weighted least squares of a step and of a
/// ramp at each of at most 64 places, then at all about the best one, which is taken where the gain of
/// chi-square has p < `level`, by 1999 simulated sets without a change, seeded by `seed`. Where the values
/// scatter by more about it than stated (p < .01), the gain is compared with that scatter instead, in the
/// simulated sets as well, and `change_stddev` follows it. Throws std::invalid_argument for other sizes and
/// standard deviations that are not positive. Some ms for 100 values.
Course fitCourse(const Eigen::VectorXd& values, const Eigen::VectorXd& stddevs, const Eigen::VectorXd& at,
                 double level, std::uint64_t seed = 1);

}  // namespace twinmap
