#include "framework/design/experiment_points.hpp"

#include "framework/design/point_set.hpp"
#include "framework/spec/parameter_box.hpp"

namespace twinmap {

Eigen::MatrixXd sampleTrainPoints(const ExperimentSpec& experiment) {
  return samplePoints(experiment.design.train, collectSampled(experiment.model), experiment.seed,
                      RandomPurpose::kTrainDesign);
}

Eigen::MatrixXd sampleTestPoints(const ExperimentSpec& experiment) {
  return samplePoints(experiment.design.test, collectSampled(experiment.model), experiment.seed,
                      RandomPurpose::kTestDesign);
}

}  // namespace twinmap
