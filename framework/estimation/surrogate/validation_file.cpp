#include "framework/estimation/surrogate/validation_file.hpp"

namespace twinmap {

void writeValidation(Hdf5Writer& file, const std::string& group, const SurrogateValidation& validation) {
  file.write(group + "/stddev_scale", validation.stddev_scale);
  file.write(group + "/coverage95", validation.coverage95);
  file.writeSamples(group + "/residual_correlation", validation.residual_correlation);
  file.write(group + "/log_density", validation.log_density);
  file.write(group + "/limit_scale", validation.limit_scale);
  file.write(group + "/limit_ratio", validation.limit_ratio);
  file.write(group + "/status", static_cast<double>(validation.status));
  if (validation.reach.isGiven()) {
    file.write(group + "/reach50", validation.reach.of50.col(0));
    file.write(group + "/reach95", validation.reach.of95.col(0));
  }
}

SurrogateValidation readValidation(const Hdf5Reader& file, const std::string& group) {
  return {
      file.readVector(group + "/stddev_scale"),
      file.readVector(group + "/coverage95"),
      file.readSamples(group + "/residual_correlation"),
      file.readNumber(group + "/log_density"),
      file.readVector(group + "/limit_scale"),
      file.readVector(group + "/limit_ratio"),
      file.readNumber(group + "/status") == 0.0 ? SurrogateStatus::kOk : SurrogateStatus::kEstimatorLimited,
      file.contains(group + "/reach95")
          ? IntervalReach{file.readVector(group + "/reach50"), file.readVector(group + "/reach95")}
          : IntervalReach{}};
}

bool fitsParameters(const SurrogateValidation& validation, Eigen::Index parameters) {
  const IntervalReach& reach = validation.reach;
  return validation.stddev_scale.size() == parameters &&
         validation.residual_correlation.rows() == parameters &&
         validation.residual_correlation.cols() == parameters &&
         (!reach.isGiven() || (reach.of50.size() == parameters && reach.of95.size() == parameters));
}

}  // namespace twinmap
