#include "framework/study/pipeline/preparation/study.hpp"

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/study/samples/stencils.hpp"

namespace twinmap {

std::vector<LocalModel> calcLocalModels(const Study& study, const Eigen::MatrixXd& points) {
  if (study.source != nullptr) {
    return calcLocalModels(study.experiment, *study.source, study.simulator, study.extractor, points,
                           study.control.threads);
  }
  return calcLocalModels(study.simulator, study.extractor, collectUnknown(study.experiment.model), points,
                         study.control.threads);
}

}  // namespace twinmap
