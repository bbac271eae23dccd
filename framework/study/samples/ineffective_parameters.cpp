#include "framework/study/samples/ineffective_parameters.hpp"

#include "framework/base/log/notice.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {
namespace {

/// Columns: the probe, then the probe with one parameter after the other moved.
Eigen::MatrixXd makeProbe(const std::vector<ParameterSpec>& parameters, double share) {
  constexpr double kMove = 0.5;
  const Eigen::VectorXd lower = calcLowerBounds(parameters), widths = calcWidths(parameters);
  Eigen::MatrixXd points = (lower + share * widths).replicate(1, lower.size() + 1);
  for (Eigen::Index j = 0; j < lower.size(); ++j) {
    points(j, j + 1) += (share < kMove ? kMove : -kMove) * widths[j];
  }
  return points;
}

}  // namespace

std::vector<std::string> findIneffective(const Simulator& prototype,
                                         const std::vector<ParameterSpec>& parameters) {
  const std::unique_ptr<Simulator> simulator = prototype.clone();
  std::vector<bool> acts(parameters.size(), false), seen(parameters.size(), false);
  for (const double share : {0.2, 0.4, 0.7}) {
    const Eigen::MatrixXd points = makeProbe(parameters, share);
    Eigen::MatrixXd responses(simulator->getLayout().getRowCount(), points.cols());
    std::vector<SampleStatus> statuses(points.cols());
    simulator->simulate(points, responses, statuses.data());
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      if (statuses[0].ok && statuses[j + 1].ok) {
        seen[j] = true;
        acts[j] = acts[j] || responses.col(0) != responses.col(static_cast<Eigen::Index>(j) + 1);
      }
    }
  }
  std::vector<std::string> names;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    if (seen[j] && !acts[j]) {
      names.push_back(parameters[j].name.text);
    }
  }
  return names;
}

std::string describeIneffective(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) {
    list += (list.empty() ? "" : ", ") + name;
  }
  return names.empty() ? "" : describeNotice(Notice::kNoEffect, list);
}

}  // namespace twinmap
