#include "framework/view/point_values.hpp"

#include "framework/models/mechanism/equations/tree.hpp"

namespace twinmap::view {

PointValues::PointValues(const ModelSpec& model, const Eigen::VectorXd& point)
    : names(model.system), numbers(model) {
  numbers.update(point);
  values = equations::calcSystemValues(model.system, names, numbers.getValues());
}

std::vector<Pose> calcPoses(const equations::SystemValues<double>& values,
                            const std::vector<double>& coordinates) {
  const std::vector<double> still(coordinates.size(), 0.0);
  std::vector<Pose> poses;
  for (const auto& motion : equations::calcMotions(values, coordinates, still)) {
    poses.push_back(motion.pose);
  }
  return poses;
}

}  // namespace twinmap::view
