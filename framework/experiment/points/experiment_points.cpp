#include "framework/experiment/points/experiment_points.hpp"

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/point_set.hpp"

namespace twinmap {

Eigen::MatrixXd sampleTrainPoints(const ExperimentSpec& experiment) {
  if (experiment.inverse_map.isNone()) {
    return Eigen::MatrixXd(countSampled(experiment.model), 0);
  }
  return samplePoints(experiment.design.train, collectSampled(experiment.model), experiment.seed,
                      RandomPurpose::kTrainDesign);
}

Eigen::MatrixXd sampleTestPoints(const ExperimentSpec& experiment) {
  return samplePoints(experiment.design.test, collectSampled(experiment.model), experiment.seed,
                      RandomPurpose::kTestDesign);
}

}  // namespace twinmap
